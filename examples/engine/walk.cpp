// A small engine: loads a .vdag file, draws it on the graphics card, and lets one walk through it
// with gravity and collision.
//
//   walk FILE.vdag [--height H] [--at X,Y,Z] [--look DEGREES] [--keys KEYS --shot FILE.ppm]
//
// W A S D walk, the mouse looks, Space jumps, Escape ends. H is the height of the
// walker in world units, by default 1/40 of the grid's side. Without --at, the walker falls from
// above the scene's middle. --keys holds each of its keys for half a second, without a window, and
// then saves a picture: "wwd " walks ahead for a second, to the right, and jumps.
#define GLFW_INCLUDE_NONE
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#define VOXDAG_IMPLEMENTATION
#include <voxdag.h>

namespace {

using Vec = std::array<double, 3>;

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot open");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A scene and the axes in which one walks in it.
struct World {
  std::string bytes;
  voxdag_scene scene{};
  int up = 1, ahead = 0, right = 2;

  explicit World(const std::string& path) : bytes(read_file(path)) {
    std::vector<char> scratch(VOXDAG_SCRATCH_BYTES(bytes.size()));
    if (const char* error =
            voxdag_open(&scene, bytes.data(), bytes.size(), scratch.data(), scratch.size()))
      throw std::runtime_error(path + ": " + error);
    if (scene.leaf_count == 0) throw std::runtime_error(path + ": no voxels");
    if (scene.info.up != 0) up = scene.info.up - 'x';
    ahead = (up + 2) % 3, right = (up + 1) % 3;
  }
  double side() const { return scene.info.voxel_size * scene.info.resolution; }
  /// Returns whether a box, in world units, holds no voxel.
  bool is_free(const Vec& low, const Vec& high) const {
    std::int32_t lo[3], hi[3], voxel[3];
    voxdag_voxel_at(&scene, low.data(), lo);
    voxdag_voxel_at(&scene, high.data(), hi);
    for (std::int32_t& bound : hi) ++bound;
    voxdag_walk walk;
    voxdag_walk_begin(&walk, &scene, lo, hi);
    return voxdag_walk_next(&walk, voxel) == 0;
  }
};

/// A box that walks. `feet` is the middle of its lower side.
struct Walker {
  const World& world;
  double height;
  Vec feet{};
  double turn = 0, tilt = 0;  ///< In radians.
  double fall = 0;            ///< Upward speed, in world units per second.

  bool fits(const Vec& at) const {
    const double radius = height / 6;
    Vec low = at, high = at;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != world.up) low[axis] -= radius, high[axis] += radius;
    high[world.up] += height;
    return world.is_free(low, high);
  }
  /// Moves along an axis while there is room. Returns false if something is in the way.
  bool move(int axis, double by) {
    const int steps = 1 + static_cast<int>(std::abs(by) / (height / 12));  // through no wall
    for (int i = 0; i < steps; ++i) {
      Vec to = feet;
      to[axis] += by / steps;
      if (axis != world.up)  // up a stair, if it is lower than the knees
        for (int stair = 1; stair <= 4 && !fits(to); ++stair)
          to[world.up] = feet[world.up] + stair * height / 16;
      if (!fits(to)) return false;
      feet = to;
    }
    return true;
  }
  /// Lets `seconds` pass. `forward` and `sideward` are -1, 0 or 1.
  void step(double seconds, double forward, double sideward, bool jumps) {
    const double speed = 1.5 * height * seconds, c = std::cos(turn), s = std::sin(turn);
    move(world.ahead, speed * (forward * c - sideward * s));
    move(world.right, speed * (forward * s + sideward * c));
    Vec below = feet;
    below[world.up] -= height / 100;
    if (jumps && !fits(below)) fall = 2.4 * height;
    fall -= 5.5 * height * seconds;  // gravity
    if (!move(world.up, fall * seconds)) fall = 0;
    const double bottom = world.scene.info.origin[world.up];
    if (feet[world.up] < bottom) feet[world.up] = bottom, fall = 0;  // the floor of the grid
  }
  /// Returns the directions right, up and ahead of the picture.
  std::array<Vec, 3> axes() const {
    const double c = std::cos(turn), s = std::sin(turn), tc = std::cos(tilt), ts = std::sin(tilt);
    std::array<Vec, 3> axes{};
    axes[0][world.right] = c, axes[0][world.ahead] = -s;
    axes[1][world.right] = -ts * s, axes[1][world.ahead] = -ts * c, axes[1][world.up] = tc;
    axes[2][world.right] = tc * s, axes[2][world.ahead] = tc * c, axes[2][world.up] = ts;
    return axes;
  }
};

constexpr const char* kVertex = R"(#version 430 core
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
constexpr const char* kHead = R"(#version 430 core
layout(std430, binding = 0) readonly buffer Nodes { uint voxdag_nodes[]; };
layout(std430, binding = 1) readonly buffer Leaves { uvec2 voxdag_leaves[]; };
uniform int voxdag_levels;
)";
constexpr const char* kFragment = R"(
uniform vec3 eye, axes[3], sun;  // the eye in sides of the grid, from its corner
uniform vec2 size;
uniform int up;
out vec4 color;

vec3 sky(vec3 d) { return mix(vec3(0.75, 0.83, 0.92), vec3(0.22, 0.42, 0.75), sqrt(max(d[up], 0.0))); }

void main() {
  vec2 at = (2.0 * gl_FragCoord.xy - size) / size.y * 0.7;
  vec3 d = normalize(at.x * axes[0] + at.y * axes[1] + axes[2]);
  float pixel = 1.4 / size.y;
  VoxdagRay ray = voxdagRay(eye, d, 3e38);
  VoxdagHit hit;
  vec3 light = sky(d);
  // Cells that are smaller than a pixel need no more detail.
  if (voxdagCast(ray, pixel * vec2(ray.t_start / ray.t_scale, 1.0), hit)) {
    float t = ray.t_start + ray.t_scale * hit.t;
    vec3 normal = vec3(0.0);
    if (hit.face >= 0) normal[hit.face >> 1] = (hit.face & 1) != 0 ? 1.0 : -1.0;
    vec3 from = eye + t * d + normal * 0.02 * exp2(-float(hit.level));
    VoxdagHit shadow;
    float lit = max(dot(normal, sun), 0.0);
    if (lit > 0.0 && voxdagCast(voxdagRay(from, sun, 3e38), vec2(0.5 * pixel * t, 0.0), shadow)) lit = 0.0;
    vec3 ambient = mix(vec3(0.12, 0.11, 0.1), vec3(0.3, 0.36, 0.46), 0.5 + 0.4 * normal[up] + 0.1 * dot(normal, sun));
    vec3 stone = vec3(0.56, 0.52, 0.47) * (lit * vec3(1.25, 1.13, 0.95) + ambient);
    light = mix(stone, light, 1.0 - exp(-0.15 * t));
  }
  color = vec4(pow(light, vec3(1.0 / 2.2)), 1.0);
}
)";

/// Draws the scene from where the walker is.
struct Renderer {
  explicit Renderer(const World& world) : world_(world) {
    const std::string fragment = kHead + read_file(VOXDAG_SHADER) + kFragment;
    program_ = glCreateProgram();
    for (const auto& [stage, text] :
         {std::pair{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, fragment.c_str()}}) {
      const GLuint shader = glCreateShader(stage);
      glShaderSource(shader, 1, &text, nullptr);
      glCompileShader(shader);
      glAttachShader(program_, shader);
    }
    glLinkProgram(program_);
    GLint is_linked = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &is_linked);
    if (!is_linked) throw std::runtime_error("OpenGL does not compile the shader");
    glUseProgram(program_);
    const voxdag_scene& scene = world.scene;
    upload(0, scene.nodes, scene.level_begin[scene.info.levels - 2] * 4);
    upload(1, scene.leaves, scene.leaf_count * 8);
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glUniform1i(place("voxdag_levels"), scene.info.levels);
    glUniform1i(place("up"), world.up);
    Vec sun;
    sun[world.up] = 0.8, sun[world.right] = 0.5, sun[world.ahead] = -0.33;
    vector("sun", sun);
  }

  void draw(const Walker& walker, int width, int height) const {
    Vec eye = walker.feet;
    eye[world_.up] += 0.93 * walker.height;
    for (int axis = 0; axis < 3; ++axis)
      eye[axis] = (eye[axis] - world_.scene.info.origin[axis]) / world_.side();
    vector("eye", eye);
    const std::array<Vec, 3> axes = walker.axes();
    for (int i = 0; i < 3; ++i) vector(("axes[" + std::to_string(i) + "]").c_str(), axes[i]);
    glUniform2f(place("size"), static_cast<float>(width), static_cast<float>(height));
    glViewport(0, 0, width, height);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  void save(const std::string& path, int width, int height) const {
    std::vector<char> pixels(std::size_t{3} * width * height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << width << ' ' << height << "\n255\n";
    for (int row = height; row-- > 0;) file.write(&pixels[std::size_t{3} * width * row], 3 * width);
    if (!file.flush()) throw std::runtime_error(path + ": cannot write");
  }
  GLint place(const char* name) const { return glGetUniformLocation(program_, name); }
  void vector(const char* name, const Vec& v) const {
    glUniform3f(place(name), static_cast<float>(v[0]), static_cast<float>(v[1]),
                static_cast<float>(v[2]));
  }
  void upload(GLuint binding, const void* bytes, std::uint64_t size) const {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(size > 0 ? size : 4),
                 size > 0 ? bytes : nullptr, GL_STATIC_DRAW);
  }
  const World& world_;
  GLuint program_ = 0;
};

void run(const std::string& file, std::map<std::string, std::string> options) {
  constexpr int kWidth = 960, kHeight = 540;
  const World world(file);
  Walker walker{world, world.side() / 40};
  for (int axis = 0; axis < 3; ++axis)
    walker.feet[axis] = world.scene.info.origin[axis] + world.side() * (axis == world.up ? 1 : 0.5);
  if (options.contains("--height")) walker.height = std::stod(options["--height"]);
  if (options.contains("--look")) walker.turn = std::stod(options["--look"]) * M_PI / 180;
  if (options.contains("--at") &&
      std::sscanf(options["--at"].c_str(), "%lf,%lf,%lf", &walker.feet[0], &walker.feet[1],
                  &walker.feet[2]) != 3)
    throw std::runtime_error("--at needs X,Y,Z");
  const bool is_script = options.contains("--keys") || options.contains("--shot");

  if (!glfwInit()) throw std::runtime_error("no display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, !is_script);
  GLFWwindow* const window = glfwCreateWindow(kWidth, kHeight, "voxdag", nullptr, nullptr);
  if (window == nullptr) throw std::runtime_error("no window with OpenGL 4.3");
  glfwMakeContextCurrent(window);
  const Renderer renderer(world);
  if (is_script) {
    for (const char key : options["--keys"])
      for (int frame = 0; frame < 30; ++frame)
        walker.step(1.0 / 60, (key == 'w') - (key == 's'), (key == 'd') - (key == 'a'), key == ' ');
    renderer.draw(walker, kWidth, kHeight);
    if (options.contains("--shot")) renderer.save(options["--shot"], kWidth, kHeight);
    std::printf("feet at %.9g %.9g %.9g\n", walker.feet[0], walker.feet[1], walker.feet[2]);
    return;
  }
  glfwSetInputMode(window, GLFW_CURSOR, GLFW_CURSOR_DISABLED);
  const auto is_down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
  double time = glfwGetTime(), x = 0, y = 0;
  glfwGetCursorPos(window, &x, &y);
  while (!glfwWindowShouldClose(window) && !is_down(GLFW_KEY_ESCAPE)) {
    const double now = glfwGetTime(), last_x = x, last_y = y;
    glfwGetCursorPos(window, &x, &y);
    walker.turn += (x - last_x) / 400;
    walker.tilt = std::clamp(walker.tilt - (y - last_y) / 400, -1.5, 1.5);
    walker.step(std::min(now - time, 0.1), is_down(GLFW_KEY_W) - is_down(GLFW_KEY_S),
                is_down(GLFW_KEY_D) - is_down(GLFW_KEY_A), is_down(GLFW_KEY_SPACE));
    time = now;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    renderer.draw(walker, width, height);
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
}

}  // namespace

int main(int argc, char** argv) try {
  std::map<std::string, std::string> options;
  for (int i = 2; i + 1 < argc; i += 2) {
    if (!std::set<std::string>{"--height", "--at", "--look", "--keys", "--shot"}.contains(argv[i]))
      throw std::runtime_error(std::string("unknown option ") + argv[i]);
    options[argv[i]] = argv[i + 1];
  }
  if (argc < 2 || argc % 2 != 0)
    throw std::runtime_error(
        "usage: walk FILE.vdag [--height H] [--at X,Y,Z] [--look DEGREES] "
        "[--keys KEYS] [--shot FILE.ppm]");
  run(argv[1], options);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
