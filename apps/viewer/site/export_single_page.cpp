#include <string_view>

#include "viewer/gzip/gzip.hpp"
#include "viewer/site/base64.hpp"
#include "viewer/site/export_site.hpp"
#include "viewer/site/scene_pieces.hpp"
#include "viewer/site/single_page.hpp"
#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag {

std::uint64_t export_single_page(const std::filesystem::path& path, const SceneBytes& scene,
                                 Work work) {
  const SinglePage page = make_single_page(page_files());
  AtomicFile file(path);
  file.write(page.before);
  Gzip gzip;
  Base64 encoder;
  const auto write = [&](std::string_view compressed) { file.write(encoder.add(compressed)); };
  for_each_piece(scene, work, [&](auto piece) { gzip.add(piece, write); });
  gzip.finish(write);
  file.write(encoder.finish());
  file.write(page.after);
  const std::uint64_t bytes = file.position();
  file.commit();
  return bytes;
}

}  // namespace voxdag
