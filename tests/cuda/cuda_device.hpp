#pragma once
/// The fixture of tests that need a CUDA device. It skips them if there is none.
#include <gtest/gtest.h>

#include "voxdag/cuda/device.hpp"

namespace voxdag {

class OnCudaDevice : public testing::Test {
 protected:
  void SetUp() override {
    const CudaDevices found = cuda_devices();
    if (found.devices.empty()) GTEST_SKIP() << "no CUDA device: " << found.why_none;
    device_ = choose_cuda_device();
  }

  CudaDevice device_;
};

}  // namespace voxdag
