/// What Highway's library, which is not compiled for browsers, says about instruction sets there.
#include <hwy/targets.h>

namespace hwy {

std::int64_t SupportedTargets() { return HWY_STATIC_TARGET; }
void SetSupportedTargetsForTest(std::int64_t) {}

}  // namespace hwy
