#include <gtest/gtest.h>

#include <filesystem>

#include "process.hpp"

namespace voxdag::cli {
namespace {

const std::vector<std::string> kCommands = {
    "build",  "convert", "info",       "verify",  "view",  "render",     "trace",
    "export", "scene",   "completion", "combine", "diff",  "components", "crop",
    "shift",  "mirror",  "rotate",     "dilate",  "erode", "fill",       "query",
    "import", "coarsen", "hollow",     "edit",    "carve", "materials"};

TEST(Usage, VersionBeginsWithItsNumber) {
  const ProcessResult result = run_voxdag({"--version"});
  EXPECT_EQ(result.status, 0);
  for (const char* word : {"version", "-v", "-V"}) EXPECT_EQ(run_voxdag({word}).out, result.out);
  EXPECT_TRUE(result.out.starts_with("voxdag " VOXDAG_VERSION "\n")) << result.out;
  for (const char* line : {"\nbuilt with: ", "\nvector instructions: "})
    EXPECT_NE(result.out.find(line), std::string::npos) << result.out;
}

TEST(Usage, HelpNamesEveryCommand) {
  const ProcessResult result = run_voxdag({"--help"});
  EXPECT_EQ(result.status, 0);
  for (const std::string& command : kCommands)
    EXPECT_NE(result.out.find("\n  " + command + " "), std::string::npos) << command;
  EXPECT_NE(result.out.find("\n  bench "), std::string::npos);
}

TEST(Usage, HelpListsCommandsByFamily) {
  const std::string help = run_voxdag({"--help"}).out;
  for (const std::string first : {"Build:\n  scene ", "Edit:\n  combine ", "Inspect:\n  info ",
                                  "Render and view:\n  render ", "Trace and query:\n  trace "})
    EXPECT_NE(help.find("\n" + first), std::string::npos) << first;
}

TEST(Usage, HelpOfEveryCommandHasAnExample) {
  for (const std::string& command : kCommands) {
    const ProcessResult result = run_voxdag({command, "--help"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("Example:\n  voxdag " + command), std::string::npos) << result.out;
  }
}

TEST(Usage, BenchRunsTheLabOrSaysHowToBuildIt) {
  if (!has_lab()) {
    // One that was built on demand may still lie beside the program.
    if (std::filesystem::exists(std::filesystem::path(VOXDAG_PROGRAM).parent_path() / "voxdag-lab"))
      GTEST_SKIP() << "built without voxdag-lab, which is there all the same";
    expect_failure(run_voxdag({"bench", "trace"}), 1, "--target voxdag_lab");
    return;
  }
  EXPECT_NE(run_voxdag({"bench", "--help"}).out.find("\n  trace "), std::string::npos);
  for (const std::string command :
       {"build", "trace", "esvo", "compact", "compact-rays", "attributes", "papers", "untrusted"}) {
    const ProcessResult result = run_voxdag({"bench", command, "--help"});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("Example:\n  voxdag bench " + command), std::string::npos)
        << result.out;
    expect_failure(run_voxdag({"bench", command, "--frobnicate"}), 2, command + " --help");
  }
}

TEST(Usage, NoCommandAndHelpPrintTheHelp) {
  const std::string help = run_voxdag({"--help"}).out;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"help"}}) {
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out, help);
  }
}

TEST(Usage, HelpOfACommandIsThatOfItsOption) {
  for (const std::string& command : kCommands)
    EXPECT_EQ(run_voxdag({"help", command}).out, run_voxdag({command, "--help"}).out);
  expect_failure(run_voxdag({"help", "biuld"}), 2, "there is no command biuld");
}

TEST(Usage, AnUnknownCommandIsNamedWithTheNearestOne) {
  expect_failure(run_voxdag({"biuld"}), 2, "there is no command biuld (did you mean build?)");
  expect_failure(run_voxdag({"xyzzy"}), 2, "there is no command xyzzy (usage");
}

TEST(Usage, UnknownArgumentsAreNamedInTheirOrderWithTheNearestOptions) {
  expect_failure(run_voxdag({"info", "a.vdag", "--jsno", "b.vdag", "--xyzzy=3"}), 2,
                 "unknown arguments: --jsno (did you mean --json?), b.vdag, --xyzzy (usage");
  expect_failure(run_voxdag({"build", "a.obj", "--resolutoin", "64"}), 2,
                 "unknown argument: --resolutoin (did you mean --resolution?)");
  expect_failure(run_voxdag({"build", "--method"}), 2, "--method");
}

TEST(Usage, OptionsOfOtherProgramsLeadToThoseHere) {
  expect_failure(run_voxdag({"render", "a.vdag", "--width", "64"}), 2,
                 "--width (did you mean --size?)");
  expect_failure(run_voxdag({"render", "a.vdag", "--turntable"}), 2,
                 "--turntable (did you mean --path?)");
  expect_failure(run_voxdag({"info", "a.vdag", "--width=3"}), 2,
                 "unknown argument: --width (usage");
}

TEST(Usage, ALongOptionWithOneDashIsNotTakenForAShortOne) {
  expect_failure(run_voxdag({"build", "none.obj", "-res", "256"}), 2,
                 "unknown argument: -res (did you mean --resolution?)");
  expect_failure(run_voxdag({"build", "none.obj", "-output", "a.vdag"}), 2,
                 "unknown argument: -output (did you mean --output?)");
  expect_failure(run_voxdag({"build", "none.obj", "-r256"}), 1, "none.obj");
}

TEST(Usage, ANumberOfBytesForMegabytesIsRefused) {
  expect_failure(run_voxdag({"build", "none.obj", "--memory", "100"}), 2,
                 "--memory: \"100\" is a number of bytes: give a unit, such as 100M");
  expect_failure(run_voxdag({"build", "none.obj", "--memory", "1073741824"}), 1, "none.obj");
}

TEST(Usage, AMissingFolderIsNamed) {
  expect_failure(run_voxdag({"build", "none.obj", "-o", "/none/at/all/x.vdag"}), 1,
                 "/none/at/all/x.vdag: cannot write: the folder /none/at/all does not exist");
}

TEST(Usage, BritishAndAmericanSpellingsOfOptionsAreEqual) {
  // An unknown option would be reported first.
  for (const char* option :
       {"--color", "--colour", "--center", "--centre", "--color-bound=0.1", "--colour-bound=0.1"})
    expect_failure(run_voxdag({"build", "none.obj", "--color", option, "-o", "none.txt"}), 2,
                   ".vdag");
  expect_failure(run_voxdag({"export", "none.vdag", "--gray", "-o", "none.glb"}), 1, "none.vdag");
  expect_failure(run_voxdag({"dilate", "none.vdag", "--neighbors", "7", "-o", "none.vdag"}), 2,
                 "--neighbours");
}

TEST(Usage, BritishAndAmericanSpellingsOfValuesAreEqual) {
  for (const char* rule : {"centre", "center"})
    expect_failure(run_voxdag({"build", "none.obj", "--solid", "--rule", rule}), 1, "none.obj");
  for (const char* unit : {"mm", "metre", "meters", "inches:centimeter", "feet"})
    expect_failure(run_voxdag({"build", "none.obj", "--unit", unit}), 1, "none.obj");
  expect_failure(run_voxdag({"build", "none.obj", "--rule", "centred"}), 2, "\"centred\"");
}

TEST(Usage, AnUnknownOptionIsNamed) {
  for (const std::string& command : kCommands)
    expect_failure(run_voxdag({command, "--frobnicate"}), 2, "voxdag " + command + " --help");
}

/// Runs a shell command in which $VOXDAG is the program.
ProcessResult run_shell(const std::string& command) {
  return Process({"bash", "-c", "VOXDAG='" + voxdag_command({})[0] + "'; " + command}).wait();
}

TEST(Usage, AFullDiskUnderStandardOutputIsAFailure) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"completion", "bash"}, {"--version"}, {"build", "--help"}})
    expect_failure(run_voxdag(arguments, "/dev/full"), 1, "standard output");
}

TEST(Usage, AClosedStandardOutputIsAFailure) {
  for (const std::string command : {"--version", "--help", "completion bash"})
    expect_failure(run_shell("$VOXDAG " + command + " >&-"), 1, "standard output");
}

TEST(Usage, AReaderThatIsGoneIsAFailure) {
  for (const std::string command : {"--help", "completion bash"})
    expect_failure(run_shell("exec 3> >(:); wait $!; $VOXDAG " + command + " >&3"), 1,
                   "standard output");
}

TEST(Usage, BashCompletionNamesEveryCommandAndParses) {
  const ProcessResult script = run_voxdag({"completion", "bash"});
  ASSERT_EQ(script.status, 0);
  for (const std::string& command : kCommands)
    EXPECT_NE(script.out.find(command + ") words="), std::string::npos);
  const std::string check = script.out +
                            "COMP_WORDS=(voxdag comple); COMP_CWORD=1; _voxdag\n"
                            "echo \"${COMPREPLY[*]}\"\n";
  const ProcessResult completed = Process({"bash", "-c", check}).wait();
  EXPECT_EQ(completed.out, "completion\n") << completed.err;
}

}  // namespace
}  // namespace voxdag::cli
