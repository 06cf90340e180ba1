#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "viewer/embedded/page_files.hpp"

namespace voxdag {
namespace {

TEST(ShaderConstants, EveryConstantOfAShaderIsDefined) {
  const std::string defined = std::string(find_page_file("constants.js")->bytes);
  // renderer.js and the shader parts define these themselves.
  const std::regex own(
      "CHANNEL_COLORS|TEXEL_BITS|MOST_STEPS|INSTANCE_STEPS|CUT_ALBEDO|HAS_(LOOK|HIDDEN|PATHS)|"
      "SMOOTH_(NEAR|RADIUS)"
      "|"
      "(SHOW|TONE_KIND|BACKGROUND)_[A-Z]+"),
      constant("\\b[A-Z]+(_[A-Z]+)+\\b");
  int shaders = 0;
  for (const PageFile& file : page_files()) {
    if (!file.path.ends_with(".glsl")) continue;
    ++shaders;
    const std::string text(file.bytes);
    for (std::sregex_iterator it(text.begin(), text.end(), constant), end; it != end; ++it) {
      const std::string name = it->str();
      EXPECT_TRUE(std::regex_match(name, own) ||
                  defined.find("#define " + name + " ") != std::string::npos)
          << file.path << ": " << name;
    }
  }
  EXPECT_GT(shaders, 8);
}

}  // namespace
}  // namespace voxdag
