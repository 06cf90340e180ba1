/// The command line of `voxdag bench esvo-rays`.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/device.hpp"
#include "cli/parse.hpp"
#include "lab/commands/commands.hpp"
#include "lab/esvo/esvo_rays.hpp"
#include "lab/runs/machine.hpp"

namespace voxdag::lab {
namespace {

/// Parses "1024=contours.esvo,cubes.esvo"; throws std::invalid_argument.
EsvoPair parse_pair(const std::string& text) {
  const std::size_t equals = text.find('='), comma = text.find(',', std::min(equals, text.size()));
  if (comma == std::string::npos) throw std::invalid_argument("is not N=CONTOURS.esvo,CUBES.esvo");
  return {parse_levels(text.substr(0, equals)), text.substr(equals + 1, comma - equals - 1),
          text.substr(comma + 1)};
}

}  // namespace

void add_bench_esvo_rays_command(const Command& bench_command, Session& session) {
  struct Arguments {
    EsvoRaysPlan plan;
    std::vector<std::string> pairs;
    std::string mesh;
  };
  const auto arguments = std::make_shared<Arguments>();
  EsvoRaysPlan& plan = arguments->plan;
  const Command command = bench_command.add(
      "esvo-rays", "Print JSON of rays and silhouettes of ESVOs that `bench esvo` built",
      "voxdag bench esvo-rays 1K=contours.esvo,cubes.esvo --mesh sibenik.obj");
  const Option pairs = command
                           .texts("octrees", arguments->pairs, "N=CONTOURS.esvo,CUBES.esvo...",
                                  "The files of both forms of a scene at each resolution")
                           .required();
  command.text("--mesh", arguments->mesh, "MESH",
               "Their mesh, for rays at triangles; leave it out if the surface is displaced");
  command.list("--size", plan.sizes, parse_image_size, "WxH,WxH...",
               "Sizes of the pictures whose rays are cast, in pixels (default: "
               "512x384,1024x768,2048x1536)");
  command.number("--views", plan.views, NumberRange::whole(1, 64), "N", "Number of cameras");
  command.number("--repeat", plan.repeat, NumberRange::whole(1, 1000), "N",
                 "Number of casts; the fastest counts");
  command.number("--lod", plan.lod_pixels, NumberRange::from(0, 1000), "PIXELS",
                 "End rays at cells of this size in the picture; 0: always at voxels");
  command.off_switch("--no-silhouettes", plan.silhouettes,
                     "Do not compare silhouettes with those of the mesh");
  add_device_option(command, plan.device);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, pairs, &session] {
    for (const std::string& text : arguments->pairs) {
      try {
        arguments->plan.pairs.push_back(parse_pair(text));
      } catch (const std::invalid_argument& wrong) {
        throw UsageError(pairs.name(), fmt::format("\"{}\": {}", text, wrong.what()));
      }
    }
    std::sort(arguments->plan.pairs.begin(), arguments->plan.pairs.end(),
              [](const EsvoPair& a, const EsvoPair& b) { return a.levels < b.levels; });
    arguments->plan.mesh = arguments->mesh;
    session.work = [arguments, &session] {
      const EsvoRays results = measure_esvo_rays(arguments->plan, session.progress);
      session.bar.clear();
      fmt::print("{}", json_text(esvo_rays_json(results, machine_json().at("processor"))));
    };
  });
}

}  // namespace voxdag::lab
