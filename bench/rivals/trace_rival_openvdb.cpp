#include "bench/rivals/trace_rival_openvdb.hpp"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/report/bench_child.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

void OpenVdbRival::add(const Grid& grid, std::span<const CastRay> casts) {
  std::vector<Ray> rays;
  for (const CastRay& cast : casts) {
    const WorldRay world = to_world_ray(grid, cast.ray);
    rays.push_back({static_cast<Vec3f>(world.origin), world.t_min,
                    static_cast<Vec3f>(world.direction), world.t_max});
  }
  files_.push_back(folder_.path() / (std::to_string(files_.size()) + ".npy"));
  NpyWriter writer(files_.back(), "<f4", {8}, sizeof(float), rays.size());
  writer.write_rows(rays.data(), rays.size());
  writer.commit();
}

std::vector<OpenVdbRival::Answer> OpenVdbRival::cast(const std::string& program,
                                                     const std::filesystem::path& vdag, int threads,
                                                     int repeat, const Progress& progress) const {
  std::vector<std::string> command{program, std::filesystem::absolute(vdag),
                                   std::to_string(threads), std::to_string(repeat)};
  command.insert(command.end(), files_.begin(), files_.end());
  const ChildResult result = run_child(command, folder_.path(), 0, progress);
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  if (result.status != 0 || !json.is_object() ||
      json.value("seconds", json).size() != files_.size())
    throw Error(program, "", "failed: " + result.err.substr(0, result.err.find('\n')));
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::ifstream hits(files_[i].string() + ".hits", std::ios::binary);
    answers.push_back({json.at("seconds").at(i).get<double>(),
                       {std::istreambuf_iterator<char>(hits), std::istreambuf_iterator<char>()}});
  }
  return answers;
}

}  // namespace voxdag
