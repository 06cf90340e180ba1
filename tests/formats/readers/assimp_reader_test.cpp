/// Tests which of assimp's importers may read a file.
#include <gtest/gtest.h>

#include <string>

#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

const char* const kDxf =
    "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n10\n0\n20\n0\n30\n0\n11\n1\n21\n0\n31\n0\n12\n0\n22"
    "\n1\n"
    "32\n0\n13\n0\n23\n1\n33\n0\n0\nENDSEC\n0\nEOF\n";

const char* const kCollada =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="f"
count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#f" count="3"
stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z"
type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene
id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>
<instance_visual_scene url="#s"/></scene></COLLADA>)";

std::string reason_of(const std::filesystem::path& path, const ReadOptions& options = {}) {
  try {
    read_mesh(path, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
    return error.reason();
  }
  return "no error";
}

class AssimpReader : public testing::Test {
 protected:
  void SetUp() override {
    write_text(dir_ / "a.dxf", kDxf);
    if (reason_of(dir_ / "a.dxf").find("built without") != std::string::npos)
      GTEST_SKIP() << "built without assimp";
  }
  const TempDir dir_;
};

TEST_F(AssimpReader, ReadsAFormatWhoseImporterSurvivesFuzzing) {
  EXPECT_EQ(read_mesh(dir_ / "a.dxf").triangles.size(), 1u);
}

TEST_F(AssimpReader, ReadsOtherFormatsOnlyWhenAsked) {
  write_text(dir_ / "a.raw", "0 0 0 1 0 0 0 1 0\n");
  EXPECT_EQ(reason_of(dir_ / "a.raw"),
            "RAW files are read only with --assimp any, because assimp's importer is not safe for "
            "untrusted files");
  ReadOptions any;
  any.any_assimp_importer = true;
  EXPECT_EQ(read_mesh(dir_ / "a.raw", any).triangles.size(), 1u);
}

TEST_F(AssimpReader, ContentDoesNotReachAnImporterThatItsExtensionHides) {
  for (const char* name : {"a.dxf", "a.md2"}) {
    write_text(dir_ / name, kCollada);
    EXPECT_NE(reason_of(dir_ / name), "no error") << name;
  }
  write_text(dir_ / "a", kCollada);  // voxdag's own reader takes it.
  EXPECT_EQ(reason_of(dir_ / "a"), "no error");
  write_text(dir_ / "b", kDxf);
  EXPECT_NE(reason_of(dir_ / "b").find("--format"), std::string::npos);
}

TEST_F(AssimpReader, KnowsEverySafeFormat) {
  for (const char* extension : {"amf", "dxf", "md2", "ms3d", "x3d", "xgl", "irrmesh", "DXF"}) {
    const std::filesystem::path path = dir_ / (std::string("b.") + extension);
    write_text(path, "no mesh");
    const std::string reason = reason_of(path);
    EXPECT_EQ(reason.find("--assimp any"), reason.npos) << path;
    EXPECT_EQ(reason.find("unknown mesh format"), reason.npos) << path;
  }
  write_text(dir_ / "b.unknown", "no mesh");
  EXPECT_EQ(reason_of(dir_ / "b.unknown"), "unknown mesh format '.unknown'");
}

TEST_F(AssimpReader, CountsAFactorOfTheFileForAssimp) {
  MemoryBudget memory(std::uint64_t{1} << 20);
  ReadOptions options;
  options.work = &memory;
  EXPECT_EQ(read_mesh(dir_ / "a.dxf", options).triangles.size(), 1u);
  std::string large = kDxf;
  large.insert(large.size() - 6, std::string(20000, '\n'));
  write_text(dir_ / "large.dxf", large);
  EXPECT_THROW(read_mesh(dir_ / "large.dxf", options), OverMemory);
}

}  // namespace
}  // namespace voxdag
