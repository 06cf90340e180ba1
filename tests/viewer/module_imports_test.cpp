#include "viewer/site/module_imports.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

std::vector<std::string> paths(std::string_view path, std::string_view source) {
  std::vector<std::string> paths;
  for (const ModuleImport& import : module_imports(path, source)) paths.push_back(import.path);
  return paths;
}

using Paths = std::vector<std::string>;

TEST(ModuleImports, EveryFormIsFound) {
  EXPECT_EQ(paths("app/app.js", "import {a} from './b.js';"), Paths{"app/b.js"});
  EXPECT_EQ(paths("app/app.js", "import {\n  a,\n  b,\n} from\n  \"../c.js\";"), Paths{"c.js"});
  EXPECT_EQ(paths("app.js", "import './a/b.js';import'./c.js'"), (Paths{"a/b.js", "c.js"}));
  EXPECT_EQ(paths("a/b/c.js", "export * from '../d.js'; export {e as f} from'../../e.js'"),
            (Paths{"a/d.js", "e.js"}));
  EXPECT_EQ(paths("app.js", "import * as a from './a.js'"), Paths{"a.js"});
  EXPECT_EQ(paths("app.js", "const a = b ? await import('./a.js') : 0"), Paths{"a.js"});
  EXPECT_TRUE(module_imports("app.js", "await import( './a.js')").at(0).is_awaited);
  EXPECT_FALSE(module_imports("app.js", "import './a.js'").at(0).is_awaited);
}

TEST(ModuleImports, OtherTextsAreNone) {
  for (const char* source :
       {"const a = './b.js';", "load('../b.js')", "/** @type {import('../b.js').B} */",
        "a.from './b.js'", "xfrom './b.js'", "import('./b.js')", "xawait import('./b.js')",
        "import {a} from 'b';", "import a from '/b.js'", "new URL('../', import.meta.url)",
        "from '"})
    EXPECT_EQ(paths("app.js", source), Paths{}) << source;
}

TEST(ModuleImports, PathsBecomeBare) {
  EXPECT_EQ(with_bare_imports("gpu/a.js", "import {b} from '../b.js';\nimport \"./c.js\";\n'./d'"),
            "import {b} from 'voxdag/b.js';\nimport \"voxdag/gpu/c.js\";\n'./d'");
}

}  // namespace
}  // namespace voxdag
