/// `voxdag bench`: runs voxdag-lab, which is a program of its own, with the same arguments.
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/commands.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/this_process.hpp"

namespace voxdag::cli {
namespace {

/// Replaces this process by voxdag-lab, which lies beside this program or in PATH. Throws Error if
/// it is not there.
[[noreturn]] void run_lab(std::vector<std::string> arguments) {
  const std::string beside = path_of_program().parent_path() / "voxdag-lab";
  std::vector<char*> argv;
  std::string name = "voxdag-lab";
  argv.push_back(name.data());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(beside.c_str(), argv.data());
  ::execvp("voxdag-lab", argv.data());
  if (errno != ENOENT) throw Error("voxdag-lab", "", std::strerror(errno));
  throw Error("voxdag-lab", "",
              "the program that measures was not found; in a build folder, build it with "
              "cmake --build . --target voxdag_lab");
}

}  // namespace

void add_bench_command(const Command& program, Session& session) {
  const Command bench =
      program.add("bench", "Benchmark builds and rays, also against other programs",
                  "voxdag bench build sponza.obj -r 2048,4096,8192");
  bench.pass_on([&session](std::vector<std::string> arguments) {
    session.work = [arguments = std::move(arguments)] { run_lab(arguments); };
  });
}

}  // namespace voxdag::cli
