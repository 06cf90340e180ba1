/// Tests what a confined child can do, and how its parent learns of its end.
#include "voxdag/core/io/confined_child.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr ChildLimits kLimits{std::uint64_t{64} << 20, 5};
using Write = ConfinedChild::Write;

/// Never returns.
void spin() {
  volatile bool on = true;
  while (on) {
  }
}

/// Returns why a child of this body gives no result.
std::string reason_of_child(const std::function<void(const Write&)>& body,
                            ChildLimits limits = kLimits) {
  ConfinedChild child(limits, body);
  try {
    char byte = 0;
    child.read(&byte, 1, {});
  } catch (const Error& error) {
    return error.reason();
  }
  return "a result";
}

TEST(ConfinedChild, ReturnsItsResults) {
  std::vector<int> numbers(1 << 20);
  for (int i = 0; i < (1 << 20); ++i) numbers[static_cast<std::size_t>(i)] = i;
  ConfinedChild child(kLimits, [&](const Write& write) {
    numbers[5] = -5;  // Its own copy.
    write(numbers.data(), numbers.size() * sizeof(int));
  });
  std::vector<int> read(numbers.size());
  child.read(read.data(), read.size() * sizeof(int), {});
  EXPECT_EQ(numbers[5], 5);
  EXPECT_EQ(read[5], -5);
  EXPECT_EQ(read[1 << 19], 1 << 19);
}

TEST(ConfinedChild, CanOnlyCompute) {
  int refused[6];
  ConfinedChild child(kLimits, [](const Write& write) {
    const auto error_of = [](long result) { return result < 0 ? errno : 0; };
    const int errors[6] = {error_of(open("/etc/passwd", O_RDONLY)),
                           error_of(open("/tmp/x", O_WRONLY | O_CREAT, 0600)),
                           error_of(socket(AF_INET, SOCK_STREAM, 0)),
                           error_of(execl("/bin/true", "true", nullptr)),
                           error_of(kill(getppid(), SIGTERM)),
                           error_of(fork())};
    write(errors, sizeof errors);
  });
  child.read(refused, sizeof refused, {});
  for (const int error : refused) EXPECT_EQ(error, EPERM);
}

TEST(ConfinedChild, HasNoFileOfItsParent) {
  for (const int file : {0, 1, 2, 4, 5, 6, 7})
    EXPECT_EQ(reason_of_child([file](const Write& write) {
                char byte = 0;
                if (::read(file, &byte, 1) >= 0 || errno != EBADF) write(&byte, 1);
              }),
              "ended without a result")
        << file;
}

TEST(ConfinedChild, TellsHowItEnded) {
  EXPECT_EQ(reason_of_child([](const Write&) {}), "ended without a result");
  EXPECT_EQ(reason_of_child([](const Write&) { throw Error("unseen"); }), "ended without a result");
  const std::string crash = reason_of_child([](const Write&) {
    volatile int* const nowhere = nullptr;
    *nowhere = 1;
  });
  EXPECT_TRUE(crash.starts_with("crashed (signal") || crash == "ended without a result") << crash;
}

TEST(ConfinedChild, KeepsItsLimits) {
  EXPECT_EQ(reason_of_child([](const Write&) { spin(); }, {1 << 20, 1}),
            "took more than 1 s of processor time");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_EQ(reason_of_child([](const Write& write) {
              const std::vector<char> large(std::size_t{128} << 20, 'x');
              write(large.data(), 1);
            }),
            "needs more than 64 MiB");
#endif
}

TEST(ConfinedChild, IsCancelled) {
  Progress progress;
  progress.cancel();
  ConfinedChild child(kLimits, [](const Write&) { spin(); });
  char byte = 0;
  EXPECT_THROW(child.read(&byte, 1, &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
