// Reads cameras in the conventions of other programs, and voxdag's own again.
#include "voxdag/render/film/camera_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/render/camera.hpp"

namespace voxdag {
namespace {

class CameraFile : public testing::Test {
 protected:
  std::string written(const std::string& text) {
    const std::string path = (dir_.path() / "camera.json").string();
    std::ofstream(path) << text;
    return path;
  }
  ViewRequest read(const std::string& text) { return read_camera_file(written(text)); }
  std::string reason(const std::string& text) {
    return reason_of([&] { read(text); });
  }

  TempDir dir_;
};

void expect_near(Vec3d a, Vec3d b) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], 1e-9);
}

TEST_F(CameraFile, ComesBackAsItWasWritten) {
  View view;
  view.eye = {1, 2, 3};
  view.target = {-4, 0.5, 1};
  view.up = {0, 0, 1};
  view.vertical_fov_degrees = 37;
  const ViewRequest request = read(camera_json(view, 640, 480));
  View again;
  again.eye = *request.eye;
  again.target = *request.target;
  again.up = *request.up;
  again.vertical_fov_degrees = *request.vertical_fov_degrees;
  const Camera a = make_camera(view, 640, 480), b = make_camera(again, 640, 480);
  expect_near(a.eye, b.eye);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {640.0, 0.0}, {100.0, 300.0}})
    expect_near(a.direction(x, y), b.direction(x, y));
}

TEST_F(CameraFile, BothMatricesAndBothConventionsSayTheSame) {
  const std::string fov = R"(, "fov_y_degrees": 50})";
  // A camera at (1,2,3) that looks along x, with y up.
  for (
      const char* matrix :
      {R"({"camera_to_world": [[0,0,-1,1],[0,1,0,2],[1,0,0,3],[0,0,0,1]])",
       R"({"transform_matrix": [[0,0,-1,1],[0,1,0,2],[1,0,0,3]])",
       R"({"world_to_camera": [[0,0,1,-3],[0,1,0,-2],[-1,0,0,1],[0,0,0,1]])",
       R"({"convention": "opencv", "camera_to_world": [[0,0,1,1],[0,-1,0,2],[1,0,0,3],[0,0,0,1]])"}) {
    const ViewRequest request = read(matrix + fov);
    expect_near(*request.eye, {1, 2, 3});
    expect_near(*request.target, {2, 2, 3});
    expect_near(*request.up, {0, 1, 0});
    EXPECT_EQ(*request.vertical_fov_degrees, 50);
  }
}

TEST_F(CameraFile, TheAngleComesFromIntrinsics) {
  const std::string pose = R"({"camera_to_world": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], )";
  const ViewRequest a = read(pose + R"("fl_y": 240, "h": 480})");
  EXPECT_NEAR(*a.vertical_fov_degrees, 90, 1e-9);
  const ViewRequest b =
      read(pose +
           R"("intrinsics": [[240,0,319.5],[0,240,239.5],[0,0,1]], "width": 640, "height": 480})");
  EXPECT_NEAR(*b.vertical_fov_degrees, 90, 1e-9);
  EXPECT_EQ(reason(pose + R"("intrinsics": [[240,0,300],[0,240,240],[0,0,1]], "width": 640,
                             "height": 480})"),
            "\"intrinsics\" has a centre that is not that of the picture");
  EXPECT_EQ(reason(pose + R"("intrinsics": [[200,0,320],[0,240,240],[0,0,1]], "height": 480})"),
            "\"intrinsics\" has pixels that are not square");
}

TEST_F(CameraFile, SaysWhatIsWrong) {
  EXPECT_EQ(reason("[]"), "must be an object");
  EXPECT_EQ(reason("{}"),
            "has neither \"camera_to_world\" nor \"world_to_camera\" nor \"transform_matrix\"");
  EXPECT_EQ(reason(R"({"camera_to_world": [[2,0,0,0],[0,1,0,0],[0,0,1,0]], "fov_y_degrees": 40})"),
            "\"camera_to_world\" is not a rotation and a translation");
  EXPECT_EQ(reason(R"({"camera_to_world": [[1,0,0],[0,1,0,0],[0,0,1,0]], "fov_y_degrees": 40})"),
            "row 0 of \"camera_to_world\" must have 4 numbers");
  EXPECT_EQ(reason(R"({"camera_to_world": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})"),
            "has neither \"fov_y_degrees\" nor \"height\"");
  EXPECT_EQ(reason(R"({"camera_to_world": [[1,0,0,0],[0,1,0,0],[0,0,1,0]], "convention": "usd"})"),
            "\"convention\" is \"usd\", neither \"opengl\" nor \"opencv\"");
}

}  // namespace
}  // namespace voxdag
