/// Tests which of assimp's importers may read a file.
#include <gtest/gtest.h>

#include <string>

#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

const char* const kDxf =
    "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n10\n0\n20\n0\n30\n0\n11\n1\n21\n0\n31\n0\n12\n0\n22"
    "\n1\n"
    "32\n0\n13\n0\n23\n1\n33\n0\n0\nENDSEC\n0\nEOF\n";

/// A square of one violet material.
const char* const kFbx = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
Objects:  {
	Geometry: 1, "Geometry::", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,2,0,0,2,2,0,0,2,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
		}
	}
	Model: 2, "Model::square", "Mesh" {
		Version: 232
	}
	Material: 3, "Material::violet", "" {
		Version: 102
		ShadingModel: "lambert"
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.5,0,1
		}
	}
}
Connections:  {
	C: "OO",1,2
	C: "OO",2,0
	C: "OO",3,2
}
)";

std::string reason_of(const std::filesystem::path& path, const ReadOptions& options = {}) {
  try {
    read_mesh(path, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
    return error.reason();
  }
  return "no error";
}

class AssimpReader : public testing::Test {
 protected:
  void SetUp() override {
    write_text(dir_ / "a.dxf", kDxf);
    if (reason_of(dir_ / "a.dxf").find("built without") != std::string::npos)
      GTEST_SKIP() << "built without assimp";
  }
  const TempDir dir_;
};

TEST_F(AssimpReader, ReadsDxf) { EXPECT_EQ(read_mesh(dir_ / "a.dxf").triangles.size(), 1u); }

TEST_F(AssimpReader, ReadsFbxAndItsColours) {
  write_text(dir_ / "a.fbx", kFbx);
  const MeshWithAppearance read = read_mesh_with_appearance(dir_ / "a.fbx");
  EXPECT_EQ(read.mesh.triangles.size(), 2u);
  ASSERT_EQ(read.mesh.materials, std::vector<std::string>{"violet"});
  const Vec3f color = read.appearance.materials[0].base_color;
  EXPECT_NEAR(color.x, 0.214, 0.001);  // sRGB 0.5
  EXPECT_EQ(color.y, 0);
  EXPECT_EQ(color.z, 1);
}

TEST_F(AssimpReader, TheUpAxisAndTheUnitAreThoseOfTheFbxFile) {
  const auto custom_of_file = [&](const std::string& text) {
    write_text(dir_ / "a.fbx", text);
    return mesh_custom(dir_ / "a.fbx");
  };
  EXPECT_EQ(custom_of_file(kFbx).up, 1);
  EXPECT_EQ(custom_of_file(kFbx).unit, "cm");
  const FormatCustom text = custom_of_file(
      "; FBX 7.4.0 project file\nGlobalSettings:  {\n"
      "P: \"OriginalUpAxis\", \"int\", \"Integer\", \"\",0\n"
      "P: \"UpAxis\", \"int\", \"Integer\", \"\",2\r\n"
      "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n}\n");
  EXPECT_EQ(text.up, 2);
  EXPECT_EQ(text.unit, "m");
  using namespace std::string_literals;
  const std::string binary = "Kaydara FBX Binary  \0S\6\0\0\0UpAxisS\3\0\0\0intS\7\0\0\0Integer"s +
                             "S\0\0\0\0I\2\0\0\0S\17\0\0\0UnitScaleFactor"s +
                             "S\6\0\0\0doubleS\6\0\0\0NumberS\0\0\0\0D\0\0\0\0\0\0\x59\x40"s;
  EXPECT_EQ(custom_of_file(binary).up, 2);
  EXPECT_EQ(custom_of_file(binary).unit, "m");
  EXPECT_EQ(custom_of_file(binary.substr(0, binary.size() - 4)).unit, "cm");
}

TEST_F(AssimpReader, IsTheSameInAChildAndInThisProcess) {
  write_text(dir_ / "a.fbx", kFbx);
  ReadOptions any;
  any.any_assimp_importer = true;
  const MeshWithAppearance child = read_mesh_with_appearance(dir_ / "a.fbx");
  const MeshWithAppearance here = read_mesh_with_appearance(dir_ / "a.fbx", any);
  EXPECT_EQ(child.mesh.vertices, here.mesh.vertices);
  EXPECT_EQ(child.mesh.triangles, here.mesh.triangles);
  EXPECT_EQ(child.mesh.materials, here.mesh.materials);
  EXPECT_EQ(child.appearance.materials[0].base_color, here.appearance.materials[0].base_color);
}

TEST_F(AssimpReader, NamesUnknownFormats) {
  write_text(dir_ / "b.unknown", "no mesh");
  EXPECT_EQ(reason_of(dir_ / "b.unknown"),
            "unknown mesh format '.unknown': 'voxdag import' reads points, voxels and volumes");
}

TEST_F(AssimpReader, CountsAFactorOfTheFileForAssimp) {
  MemoryBudget memory(std::uint64_t{1} << 20);
  ReadOptions options;
  options.work = &memory;
  EXPECT_EQ(read_mesh(dir_ / "a.dxf", options).triangles.size(), 1u);
  std::string large = kDxf;
  large.insert(large.size() - 6, std::string(20000, '\n'));
  write_text(dir_ / "large.dxf", large);
  EXPECT_THROW(read_mesh(dir_ / "large.dxf", options), OverMemory);
}

}  // namespace
}  // namespace voxdag
