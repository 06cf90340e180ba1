#include "cli/device.hpp"

#include <cmath>
#include <fstream>

#include "npy_rays.hpp"
#include "sponge.hpp"

namespace voxdag::cli {
namespace {

class DeviceOption : public Sponge {
 protected:
  static ProcessResult trace(const std::string& device, const std::string& hits) {
    write_text(path("rays.npy"), rays_npy({{0.01F, 9, 0.01F, 0, 0, -1, 0, HUGE_VALF}}));
    return run_voxdag({"trace", path("in.vdag"), "--rays", path("rays.npy"), "-o", path(hits),
                       "--device", device});
  }
};

TEST(ParseDevice, TakesKindAndNumber) {
  EXPECT_EQ(parse_device("cpu").kind, DeviceChoice::Kind::kCpu);
  EXPECT_EQ(parse_device("auto").kind, DeviceChoice::Kind::kAuto);
  EXPECT_EQ(parse_device("cuda").index, -1);
  EXPECT_EQ(parse_device("cuda:3").index, 3);
  for (const char* text : {"", "gpu", "cuda:", "cuda:-1", "cuda:1x", "CPU"})
    EXPECT_THROW(parse_device(text), std::invalid_argument) << text;
}

TEST_F(DeviceOption, CudaWithoutADeviceIsOneClearLine) {
  const CudaDevices found = cuda_devices();
  if (!found.devices.empty()) GTEST_SKIP() << "there is " << found.devices[0].name;
  expect_failure(trace("cuda", "cuda.npy"), 1, "--device cuda: no CUDA device: " + found.why_none);
  EXPECT_FALSE(exists("cuda.npy"));
}

TEST_F(DeviceOption, AutoFindsTheSameHitsAndSaysWhere) {
  const ProcessResult cpu = trace("cpu", "cpu.npy"), automatic = trace("auto", "auto.npy");
  ASSERT_EQ(automatic.status, 0) << automatic.err;
  EXPECT_EQ(read_text(path("cpu.npy")), read_text(path("auto.npy")));
  EXPECT_NE(cpu.out.find("1 hits, on the CPU\n"), std::string::npos) << cpu.out;
  const CudaDevices found = cuda_devices();
  const std::string name = found.devices.empty() ? "the CPU" : found.devices[0].name;
  EXPECT_NE(automatic.out.find("1 hits, on " + name), std::string::npos) << automatic.out;
}

TEST_F(DeviceOption, PicturesAndBenchmarksTakeIt) {
  const std::string in = path("in.vdag"), out = path("auto.png"), json = path("rays.json");
  const ProcessResult picture =
      run_voxdag({"render", in, "-o", out, "--size", "32x18", "--device", "auto"});
  ASSERT_EQ(picture.status, 0) << picture.err;
  EXPECT_NE(picture.out.find("rays/s on "), std::string::npos) << picture.out;
  const CudaDevices found = cuda_devices();
  if (!found.devices.empty()) GTEST_SKIP() << "there is " << found.devices[0].name;
  const std::string reason = "no CUDA device: " + found.why_none;
  expect_failure(run_voxdag({"render", in, "-o", path("cuda.png"), "--device", "cuda"}), 1, reason);
  EXPECT_FALSE(exists("cuda.png"));
  if (!has_lab()) return;
  expect_failure(run_voxdag({"bench", "trace", in, "-o", json, "--device", "cuda"}), 1, reason);
  EXPECT_FALSE(exists("rays.json"));
  const ProcessResult esvo =
      run_voxdag({"bench", "esvo", "Sponge=" + path("sponge.ply"), "-r", "16", "--size", "40x32",
                  "--no-silhouettes", "--device", "cuda"});
  EXPECT_EQ(esvo.status, 1);
  EXPECT_EQ(esvo.err, "voxdag: --device cuda: " + reason + "\n");
  const ProcessResult papers =
      run_voxdag({"bench", "papers", "--quick", "--device", "cuda", "-q", "-o", path("report")});
  EXPECT_EQ(papers.status, 1);
  EXPECT_EQ(papers.err, "voxdag: --device cuda: " + reason + "\n");
  EXPECT_FALSE(exists("report/report.json"));
}

TEST_F(DeviceOption, OtherDevicesAreBadUsage) {
  expect_failure(trace("gpu", "gpu.npy"), 2, "\"gpu\" is not cpu, cuda");
}

}  // namespace
}  // namespace voxdag::cli
