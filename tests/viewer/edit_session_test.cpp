#include "viewer/edit/edit_session.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "edit/edit_model.hpp"
#include "edit_page.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/vdag_writer.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr int kSessionLevels = 5;

/// A scene of random voxels, its session, and what a page and a grid of voxels say of it.
class Session : public testing::Test {
 protected:
  Session()
      : voxels_(random_voxels(kSessionLevels, 2000, 7)),
        base_(brute_svdag(kSessionLevels, voxels_)),
        mirror_(base_.view()),
        session_({base_.view(), {}}, grid(), dir_ / "suggested.vdag",
                 [](const EditSnapshot& version, const fs::path& path) {
                   const Svdag dag = version.svdag();
                   write_vdag(path, dag.view(), example_metadata(dag.view()));
                 }) {
    mirror_.take(session_.open());
  }

  static Grid grid() { return {kSessionLevels, {0, 0, 0}, 1, kSubvoxels}; }
  std::string stroke(const std::string& lines, bool goes_on = false) {
    return session_.stroke(mirror_.writer, lines, goes_on);
  }

  const TempDir dir_;
  const std::vector<Vec3i> voxels_;
  const Svdag base_;
  EditMirror mirror_;
  EditSession session_;
};

TEST_F(Session, APageThatTakesAllUpdatesShowsTheVoxelsOfTheScene) {
  std::mt19937 random(5);
  const auto number = [&](int most) { return static_cast<int>(random() % most); };
  std::vector<EditModel> versions = {EditModel(kSessionLevels, voxels_)};
  std::size_t now = 0;
  for (int i = 0; i < 60; ++i) {
    if (const int action = number(5); action == 0 && now > 0) {
      mirror_.take(session_.undo(mirror_.writer));
      --now;
    } else if (action == 1 && now + 1 < versions.size()) {
      mirror_.take(session_.redo(mirror_.writer));
      ++now;
    } else {
      versions.resize(now + 1, versions[now]);
      EditModel next = versions[now];
      for (int part = 0; part < 3; ++part) {
        const bool adds = number(2) == 0;
        const Vec3i at{number(32), number(32), number(32)};
        const int radius = 1 + number(6);
        const EditShape ball = make_ball(grid(), Vec3d(at), radius);
        if (adds)
          next.add(ball, {});
        else
          next.remove(ball);
        const std::string line = std::string(adds ? "add" : "remove") + ",ball," +
                                 std::to_string(at.x) + "," + std::to_string(at.y) + "," +
                                 std::to_string(at.z) + "," + std::to_string(radius);
        mirror_.take(stroke(line, part > 0));
      }
      versions.push_back(next);
      ++now;
    }
    ASSERT_EQ(mirror_.dag(), versions[now].dag()) << i;
    EXPECT_EQ(mirror_.undos, now);
    EXPECT_EQ(mirror_.redos, versions.size() - 1 - now);
  }
}

TEST_F(Session, UndoAndRedoSendRootsAlone) {
  mirror_.take(stroke("remove,ball,16,16,16,9\nadd,box,0,0,0,4,4,4"));
  const std::uint32_t edited = mirror_.root;
  const std::string undone = session_.undo(mirror_.writer);
  EXPECT_EQ(undone.size(), 4u * EditUpdate::kHeadWords);
  mirror_.take(undone);
  EXPECT_EQ(mirror_.dag(), base_);
  const std::string redone = session_.redo(mirror_.writer);
  EXPECT_EQ(redone.size(), 4u * EditUpdate::kHeadWords);
  mirror_.take(redone);
  EXPECT_EQ(mirror_.root, edited);
}

TEST_F(Session, ASceneWithoutVoxelsHasNoRoot) {
  mirror_.take(stroke("remove,box,0,0,0,32,32,32"));
  EXPECT_EQ(mirror_.root, EditNodes::kNone);
  EXPECT_TRUE(mirror_.dag().view().is_empty());
}

TEST_F(Session, APageThatOpensLaterHasAllEditsAndIsTheOnlyOneThatEdits) {
  mirror_.take(stroke("remove,ball,16,16,16,9"));
  EditMirror other(base_.view());
  other.take(session_.open());
  EXPECT_EQ(other.dag(), mirror_.dag());
  EXPECT_EQ(other.undos, 1u);
  EXPECT_THROW(stroke("remove,ball,1,1,1,1"), NotTheWriter);
  EXPECT_THROW(session_.undo(mirror_.writer), NotTheWriter);
  EXPECT_THROW(session_.save(mirror_.writer, "a", false), NotTheWriter);
  other.take(session_.stroke(other.writer, "add,box,0,0,0,8,8,8", false));
  other.take(session_.undo(other.writer));
  EXPECT_EQ(other.dag(), mirror_.dag());
}

TEST_F(Session, ARequestWithAWrongLineChangesNothing) {
  mirror_.take(stroke("remove,ball,16,16,16,3"));
  const Svdag before = mirror_.dag();
  for (const char* line : {"remove,ball,1,1", "dig,ball,1,1,1,1", "undo", "redo",
                           "paint,ball,nan,1,1,1", "paint,ball,1,1,1,1,#ff0000", "\xFF\xFE"}) {
    const std::string reason =
        error_of([&] { stroke(std::string("remove,ball,8,8,8,9\n") + line); });
    EXPECT_NE(reason, "") << line;
    mirror_.take(session_.redo(mirror_.writer));
    EXPECT_EQ(mirror_.dag(), before) << line;
    EXPECT_EQ(mirror_.undos, 1u);
  }
  EXPECT_TRUE(error_of([&] { stroke("remove,ball,1,1,1,1\nundo"); }).starts_with("line 2: "));
}

TEST_F(Session, NamesThatLeaveTheFolderAreRefused) {
  for (const std::string name :
       {"", ".", "..", "../a", "/tmp/a", "a/b", "a\\b", ".hidden", "a\nb", "\xFF", "..\\a"})
    EXPECT_THROW(session_.save(mirror_.writer, name, true), Error) << name;
  EXPECT_THROW(session_.save(mirror_.writer, std::string(300, 'a'), true), Error);
  EXPECT_THROW(session_.save(mirror_.writer, std::string("a\0b", 3), true), Error);
  // Nor may a link lead out, nor a folder be replaced.
  const TempDir elsewhere;
  fs::create_symlink(elsewhere / "target.vdag", dir_ / "link.vdag");
  fs::create_directory(dir_ / "folder.vdag");
  EXPECT_THROW(session_.save(mirror_.writer, "link", true), Error);
  EXPECT_THROW(session_.save(mirror_.writer, "folder", true), Error);
  EXPECT_TRUE(fs::is_empty(elsewhere.path()));
}

TEST_F(Session, AFileIsReplacedOnlyIfAsked) {
  EXPECT_FALSE(session_.has_unsaved());
  mirror_.take(stroke("remove,ball,16,16,16,9"));
  EXPECT_TRUE(session_.has_unsaved());
  session_.save(mirror_.writer, "first name", false);
  EXPECT_FALSE(session_.has_unsaved());
  EXPECT_EQ(read_text(dir_ / "first name.vdag"), vdag_file_bytes(mirror_.dag()));
  mirror_.take(session_.undo(mirror_.writer));
  EXPECT_TRUE(session_.has_unsaved());
  EXPECT_THROW(session_.save(mirror_.writer, "first name.vdag", false), FileExists);
  session_.save(mirror_.writer, "first name.vdag", true);
  EXPECT_EQ(read_text(dir_ / "first name.vdag"), vdag_file_bytes(base_));
}

}  // namespace
}  // namespace voxdag
