#include "voxdag/cuda/device.hpp"

#include <gtest/gtest.h>

#include "cuda/cuda_device.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device_scene.hpp"

namespace voxdag {
namespace {

std::string refusal(int index) {
  try {
    choose_cuda_device(index);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(CudaDevices, WithoutADeviceThereIsAReason) {
  const CudaDevices found = cuda_devices();
  EXPECT_EQ(found.devices.empty(), !found.why_none.empty());
  if (found.devices.empty()) {
    EXPECT_EQ(refusal(-1), "no CUDA device: " + found.why_none);
  }
}

TEST(CudaDevices, AnUnknownDeviceNumberIsRefused) {
  EXPECT_EQ(refusal(1000).rfind("no CUDA device", 0), 0u);
}

using OnCuda = OnCudaDevice;

TEST_F(OnCuda, ADeviceHasANameAndMemory) {
  EXPECT_FALSE(device_.name.empty());
  EXPECT_GE(device_.compute_capability, kMinComputeCapability);
  EXPECT_GT(device_.memory_bytes, std::uint64_t{1} << 28);
  EXPECT_GT(device_.multiprocessors, 0);
}

TEST_F(OnCuda, ADagThatDoesNotFitIsRefusedBeforeItIsRead) {
  SvdagView dag;
  dag.leaf_block_count = std::uint64_t{1} << 45;
  try {
    const DeviceScene copy(device_, dag);
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("out of memory: the DAG needs 268435456.0 MiB"), std::string::npos) << text;
    EXPECT_NE(text.find(device_.name), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace voxdag
