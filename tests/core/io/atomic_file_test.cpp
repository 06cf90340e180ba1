#include "voxdag/core/io/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <iterator>
#include <string>

#include "support/error_of.hpp"
#include "support/file_size_limit.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/io/unfinished_files.hpp"

#ifndef __NR_rename  // 64-bit ARM
#define __NR_rename __NR_renameat
#endif

namespace voxdag {
namespace {

/// The system call by which rename() renames.
constexpr unsigned kRename = __NR_rename;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TempDir dir;
  AtomicFile file(dir / "out");
  file.write("complete");
  EXPECT_FALSE(std::filesystem::exists(dir / "out"));
  file.commit();
  EXPECT_EQ(read_text(dir / "out"), "complete");
  EXPECT_EQ(dir.count(), 1);
}

/// Returns whether the file system of `dir` supports files without a name.
bool has_nameless_files(const TempDir& dir) {
  const int descriptor = open_nameless_file(dir.path());
  if (descriptor >= 0) close(descriptor);
  return descriptor >= 0;
}

TEST(AtomicFile, HasNoNameAtAllUntilCommitted) {
  const TempDir dir;
  if (!has_nameless_files(dir)) GTEST_SKIP() << "the file system has no files without a name";
  AtomicFile file(dir / "out");
  file.write("half");
  EXPECT_EQ(dir.count(), 0);
}

/// Forbids this process to give names to files from now on.
void forbid_linkat() {
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_linkat, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program{std::size(filter), filter};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    std::exit(2);
}

TEST(AtomicFile, IsCopiedIfTheSystemRefusesToNameIt) {
  const TempDir dir;
  const std::string text(3 << 20, 'x');
  const auto write_without_names = [&] {
    forbid_linkat();
    AtomicFile file(dir / "out");
    file.write(text);
    file.commit();
    std::exit(0);
  };
  EXPECT_EXIT(write_without_names(), testing::ExitedWithCode(0), "");
  EXPECT_EQ(read_text(dir / "out"), text);
  EXPECT_EQ(dir.count(), 1);
}

TEST(AtomicFile, AnExceptionLeavesNothingAndKeepsTheOldFile) {
  const TempDir dir;
  write_text(dir / "out", "old");
  EXPECT_THROW(
      {
        AtomicFile file(dir / "out");
        file.write("new");
        throw Cancelled();
      },
      Cancelled);
  EXPECT_EQ(read_text(dir / "out"), "old");
  EXPECT_EQ(dir.count(), 1);
}

TEST(AtomicFile, UnfinishedFilesAreRemovedBeforeASignalEndsTheProcess) {
  const TempDir dir;
  AtomicFile complete(dir / "complete"), partial(dir / "partial");
  complete.write("whole");
  complete.commit();
  partial.write("half");
  remove_unfinished_files();
  EXPECT_EQ(read_text(dir / "complete"), "whole");
  EXPECT_EQ(dir.count(), 1);
  EXPECT_NE(error_of([&] { partial.commit(); }).find("partial"), std::string::npos);
}

/// Returns the file that a process leaves behind if it dies in the system call `number` while it
/// writes "out". With `only_named`, the process uses no nameless files.
std::filesystem::path leftover_of_a_process_killed_in(const TempDir& dir, unsigned number,
                                                      bool only_named) {
  const pid_t child = fork();
  if (child == 0) {
    const auto flag = static_cast<unsigned>(O_TMPFILE & ~O_DIRECTORY);
    sock_filter filter[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 4, 0),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, only_named ? __NR_openat : ~0u, 0, 2),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, flag, 2, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
    };
    const sock_fprog program{std::size(filter), filter};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
      _exit(2);
    write_whole_file(dir / "out", "new");
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << status;
  const std::string prefix = "out.voxdag-" + std::to_string(child) + "-";
  for (const auto& entry : std::filesystem::directory_iterator(dir.path()))
    if (entry.path().filename().string().starts_with(prefix)) return entry.path();
  return {};
}

TEST(AtomicFile, RemovesTheLeftoverOfAKilledProcessForTheSameOutput) {
  for (const unsigned call : {kRename, static_cast<unsigned>(__NR_write)})
    for (const bool only_named : {false, true}) {
      const TempDir dir;
      write_text(dir / "out", "old");
      const auto left = leftover_of_a_process_killed_in(dir, call, only_named);
      // A process that is killed while it writes a nameless file leaves nothing.
      const bool leaves_one = only_named || call == kRename || !has_nameless_files(dir);
      EXPECT_EQ(!left.empty(), leaves_one);
      EXPECT_EQ(dir.count(), leaves_one ? 2 : 1);
      EXPECT_EQ(read_text(dir / "out"), "old");
      { const AtomicFile other(dir / "other"); }
      EXPECT_EQ(dir.count(), leaves_one ? 2 : 1);
      write_whole_file(dir / "out", "newer");
      EXPECT_EQ(dir.count(), 1);
      EXPECT_EQ(read_text(dir / "out"), "newer");
    }
}

TEST(AtomicFile, RemovesLeftoversOfDeadProcessesOnly) {
  const TempDir dir;
  write_text(dir / "out", "old");
  const auto left = leftover_of_a_process_killed_in(dir, kRename, true);
  ASSERT_FALSE(left.empty());
  const std::string dead = left.filename().string().substr(0, left.filename().string().rfind('-'));
  write_text(dir / ("out.voxdag-" + std::to_string(getpid()) + "-7"), "of a running process");
  write_text(dir / (dead + "-01"), "no such serial number");
  write_text(dir / (dead + "-1.vdag"), "another name");
  write_text(dir / ("in" + dead.substr(3) + "-1"), "of another output");
  write_text(dir / (dead + "-2"), "locked");
  const int locked = open((dir / (dead + "-2")).c_str(), O_RDONLY);
  ASSERT_EQ(flock(locked, LOCK_EX), 0);
  std::filesystem::create_symlink("out", dir / (dead + "-3"));
  std::filesystem::create_directory(dir / (dead + "-4"));
  write_text(dir / (dead + "-5.locktest.2"), "of Open MPI");
  write_text(dir / (dead + "-5.locktest.x"), "no such rank");
  const long before = dir.count();
  write_whole_file(dir / "out", "newer");
  EXPECT_EQ(dir.count(), before - 2);
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_FALSE(std::filesystem::exists(dir / (dead + "-5.locktest.2")));
  close(locked);
}

TEST(AtomicFile, GivesTheNewFileNoSetUserIdBit) {
  const TempDir dir;
  write_text(dir / "out", "old");
  ASSERT_EQ(chmod((dir / "out").c_str(), 06755), 0);
  write_whole_file(dir / "out", "new");
  struct stat info {};
  ASSERT_EQ(stat((dir / "out").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0755u);
}

TEST(AtomicFile, ReplacesTheOldFileAndKeepsItsMode) {
  const TempDir dir;
  write_text(dir / "out", "old");
  chmod((dir / "out").c_str(), 0640);
  AtomicFile file(dir / "out");
  file.write("new");
  file.commit();
  EXPECT_EQ(read_text(dir / "out"), "new");
  struct stat info {};
  ASSERT_EQ(stat((dir / "out").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST(AtomicFile, ReplacesTheTargetOfASymbolicLink) {
  const TempDir dir;
  write_text(dir / "real", "old");
  std::filesystem::create_symlink("real", dir / "link");
  AtomicFile file(dir / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "link"));
  EXPECT_EQ(read_text(dir / "real"), "new");
}

TEST(AtomicFile, CreatesTheTargetOfASymbolicLink) {
  const TempDir dir;
  std::filesystem::create_symlink("absent", dir / "link");
  std::filesystem::create_symlink(dir / "link", dir / "second");
  std::filesystem::create_symlink("round", dir / "round");
  write_whole_file(dir / "second", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "link"));
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "second"));
  EXPECT_EQ(read_text(dir / "absent"), "new");
  EXPECT_NE(error_of([&] { AtomicFile file(dir / "round"); }).find("symbolic links"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "round"));
}

TEST(AtomicFile, WritesToADescriptorFromItsPosition) {
  const TempDir dir;
  for (const int flags : {O_RDWR, O_WRONLY | O_APPEND}) {
    write_text(dir / "out", "0123456789");
    const int descriptor = open((dir / "out").c_str(), flags);
    lseek(descriptor, 4, SEEK_SET);
    AtomicFile file("/dev/fd/" + std::to_string(descriptor));
    file.write("abc");
    const std::string why = error_of([&] { file.overwrite(1, "x", 1); });
    file.commit();
    const bool is_appended = (flags & O_APPEND) != 0;
    EXPECT_EQ(why.find("cannot write") != std::string::npos, is_appended) << why;
    EXPECT_EQ(read_text(dir / "out"), is_appended ? "0123456789abc" : "0123axc789");
    EXPECT_EQ(lseek(descriptor, 0, SEEK_CUR), is_appended ? 13 : 7);
    close(descriptor);
  }
}

TEST(AtomicFile, HoldsWhatWasWrittenInPiecesOfAnySize) {
  const TempDir dir;
  std::string expected;
  AtomicFile file(dir / "out");
  for (const std::size_t size :
       {1, 1000, 1 << 20, 3, (1 << 20) - 1, 5 << 20, 0, 7, 700000, 700000}) {
    std::string piece(size, '\0');
    for (std::size_t i = 0; i < size; ++i) piece[i] = static_cast<char>(i * 31 + expected.size());
    file.write(piece);
    expected += piece;
    EXPECT_EQ(file.position(), expected.size());
  }
  file.write_zeros(10000);
  expected.append(10000, '\0');
  file.commit();
  EXPECT_EQ(read_text(dir / "out"), expected);
}

TEST(AtomicFile, OverwritesEarlierBytes) {
  const TempDir dir;
  AtomicFile file(dir / "out");
  file.write("count=??, data");
  file.overwrite(6, "42", 2);
  file.write("!");
  file.commit();
  EXPECT_EQ(read_text(dir / "out"), "count=42, data!");
}

TEST(AtomicFile, TwoWritersOfOneOutputDoNotConflict) {
  const TempDir dir;
  AtomicFile first(dir / "out"), second(dir / "out");
  first.write("first");
  second.write("second");
  first.commit();
  second.commit();
  EXPECT_EQ(read_text(dir / "out"), "second");
  EXPECT_EQ(dir.count(), 1);
}

TEST(AtomicFile, AMovedFileIsRemovedOnce) {
  const TempDir dir;
  {
    AtomicFile first(dir / "out");
    first.write("text");
    AtomicFile second(std::move(first));
    second.commit();
  }
  EXPECT_EQ(read_text(dir / "out"), "text");
}

TEST(AtomicFile, AFullDeviceIsAnError) {
  AtomicFile file("/dev/full");
  EXPECT_EQ(error_of([&] {
              file.write("lost");
              file.commit();
            }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

TEST(AtomicFile, AFullDeviceIsAnErrorForLargeWritesToo) {
  AtomicFile file("/dev/full");
  const std::string large(3 << 20, 'x');
  EXPECT_EQ(error_of([&] { file.write(large); }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

TEST(AtomicFile, AFileThatGrowsPastTheLimitIsAnErrorAndIsRemoved) {
  const TempDir dir;
  const FileSizeLimit limit(3 << 20);
  const std::string message = error_of([&] {
    AtomicFile file(dir / "out");
    const std::string piece(700000, 'x');
    for (int i = 0; i < 10; ++i) file.write(piece);
    file.commit();
  });
  EXPECT_EQ(message, (dir / "out").string() + ": byte 3145728: cannot write: File too large");
  EXPECT_EQ(dir.count(), 0);
}

TEST(AtomicFile, AMissingDirectoryIsReportedAtOnce) {
  const TempDir dir;
  EXPECT_EQ(error_of([&] { AtomicFile file(dir / "none/out"); }),
            (dir / "none/out").string() + ": cannot write: the folder " + (dir / "none").string() +
                " does not exist");
}

TEST(AtomicFile, ADirectoryIsNotAFile) {
  const TempDir dir;
  EXPECT_EQ(error_of([&] { AtomicFile file(dir.path()); }),
            dir.path().string() + ": cannot write: Is a directory");
  EXPECT_EQ(error_of([&] { AtomicFile file(dir.path() / ""); }),
            (dir.path() / "").string() + ": cannot write: Is a directory");
}

TEST(AtomicFile, ADirectoryWithoutPermissionIsAnError) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TempDir dir;
  chmod(dir.path().c_str(), 0500);
  EXPECT_EQ(error_of([&] { AtomicFile file(dir / "out"); }),
            (dir / "out").string() + ": cannot write: Permission denied");
}

TEST(AtomicFile, ADeviceIsWrittenDirectly) {
  AtomicFile file("/dev/null");
  file.write("gone");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, TheLongestNameWorks) {
  const TempDir dir;
  const std::string name(255, 'n');
  AtomicFile file(dir / name);
  file.write("text");
  file.commit();
  EXPECT_EQ(read_text(dir / name), "text");
}

}  // namespace
}  // namespace voxdag
