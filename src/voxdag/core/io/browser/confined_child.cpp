#include "voxdag/core/io/confined_child.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {

ConfinedChild::ConfinedChild(const ChildLimits& limits, const std::function<void(const Write&)>&)
    : limits_(limits) {
  throw Error("", "", "a browser makes no processes");
}

ConfinedChild::~ConfinedChild() = default;

void ConfinedChild::read(void*, std::size_t, const Work&) { throw_reason(); }

void ConfinedChild::throw_reason() { throw Error("", "", "a browser makes no processes"); }

}  // namespace voxdag
