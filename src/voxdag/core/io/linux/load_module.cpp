#include "voxdag/core/io/load_module.hpp"

#include <dlfcn.h>

namespace voxdag {

const void* load_module(const char* file, const char* symbol, std::string& reason) {
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  const void* const address = library != nullptr ? ::dlsym(library, symbol) : nullptr;
  if (address == nullptr) reason = ::dlerror();
  return address;
}

}  // namespace voxdag
