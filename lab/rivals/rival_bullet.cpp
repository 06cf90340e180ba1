/// Bullet sweeps spheres against the triangles of a mesh, for `voxdag bench contacts`. Uses
/// voxdag's mesh reader. Lengths are scaled so that the first sphere has the radius 0.5, because
/// Bullet's tolerances are meant for bodies of that size.
///
///   rival_bullet MESH SWEEPS.npy TIMES.npy
///
/// SWEEPS.npy has N x 7 float64: centre, radius, motion. TIMES.npy gets N x 1 float64: the part of
/// the motion until the sphere touches a triangle, 1 if it does not.
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace {

struct Sweep {
  double centre[3], radius, motion[3];
};

void run(const char* mesh_file, const char* sweeps_file, const char* times_file) {
  voxdag::Mesh mesh = voxdag::read_mesh(mesh_file);
  voxdag::NpyReader reader(sweeps_file, "<f8", {7}, sizeof(double));
  std::vector<Sweep> sweeps(reader.rows());
  reader.read_rows(sweeps.data(), sweeps.size());
  const double scale = sweeps.empty() ? 1 : 0.5 / sweeps[0].radius;
  const auto to_bullet = [&](const double* world) {
    return btVector3(static_cast<btScalar>((world[0] - mesh.origin.x) * scale),
                     static_cast<btScalar>((world[1] - mesh.origin.y) * scale),
                     static_cast<btScalar>((world[2] - mesh.origin.z) * scale));
  };
  for (voxdag::Vec3f& vertex : mesh.vertices) vertex = vertex * static_cast<float>(scale);

  btIndexedMesh part;
  part.m_numTriangles = static_cast<int>(mesh.triangles.size());
  part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles.data());
  part.m_triangleIndexStride = sizeof(voxdag::Triangle);
  part.m_numVertices = static_cast<int>(mesh.vertices.size());
  part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.vertices.data());
  part.m_vertexStride = sizeof(voxdag::Vec3f);
  part.m_vertexType = PHY_FLOAT;
  btTriangleIndexVertexArray triangles;
  triangles.addIndexedMesh(part, PHY_INTEGER);
  btBvhTriangleMeshShape shape(&triangles, true);
  btCollisionObject object;
  object.setCollisionShape(&shape);

  std::vector<double> times(sweeps.size());
  const auto sweep = [&](std::size_t i) {
    const btSphereShape sphere(static_cast<btScalar>(sweeps[i].radius * scale));
    const btVector3 from = to_bullet(sweeps[i].centre);
    const btVector3 motion(static_cast<btScalar>(sweeps[i].motion[0] * scale),
                           static_cast<btScalar>(sweeps[i].motion[1] * scale),
                           static_cast<btScalar>(sweeps[i].motion[2] * scale));
    const btTransform begin(btMatrix3x3::getIdentity(), from),
        end(btMatrix3x3::getIdentity(), from + motion);
    btCollisionWorld::ClosestConvexResultCallback result(from, from + motion);
    btCollisionWorld::objectQuerySingle(&sphere, begin, end, &object, &shape,
                                        object.getWorldTransform(), result, 0);
    times[i] = result.hasHit() ? static_cast<double>(result.m_closestHitFraction) : 1;
  };
  double least = HUGE_VAL, least_cpu = HUGE_VAL;
  for (int i = 0; i < 4; ++i) {  // The first is a warm-up.
    const std::clock_t cpu = std::clock();
    const auto start = std::chrono::steady_clock::now();
    voxdag::parallel_for(sweeps.size(), 64, sweep);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (i == 0) continue;
    least = std::fmin(least, took.count());
    least_cpu =
        std::fmin(least_cpu, 1000.0 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  voxdag::NpyWriter writer(times_file, "<f8", {1}, sizeof(double), times.size());
  writer.write_rows(times.data(), times.size());
  writer.commit();
  const auto count = static_cast<double>(sweeps.size());
  std::printf("{\"per_ms\": %.17g, \"per_cpu_ms\": %.17g}\n", count / least, count / least_cpu);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fputs("usage: rival_bullet MESH SWEEPS.npy TIMES.npy\n", stderr);
    return 2;
  }
  run(argv[1], argv[2], argv[3]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
