/// Runs the tests. Exit status 77: all of them were skipped, for the reason that each prints.
#include <gtest/gtest.h>

#include <cstdio>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const int status = RUN_ALL_TESTS();
  const auto& run = *testing::UnitTest::GetInstance();
  if (run.test_to_run_count() == 0) {
    std::puts("skipped: this build has no such tests");
    return 77;
  }
  const bool all_skipped = run.skipped_test_count() == run.test_to_run_count();
  return status == 0 && all_skipped ? 77 : status;
}
