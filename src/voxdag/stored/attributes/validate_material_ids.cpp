#include "voxdag/stored/attributes/validate_material_ids.hpp"

#include <string>

#include "voxdag/stored/attributes/validate_cell_pages.hpp"

namespace voxdag {
namespace {

/// Returns the first bit after the page of `values` ids that begins at bit `at`.
std::uint64_t page_end(const MaterialIdsView& view, std::uint64_t page, std::uint64_t at,
                       std::uint64_t values) {
  const std::uint64_t end = view.word_count * 64;
  const int id_bits = view.id_bits();
  std::uint64_t before = view.materials;  // no id
  for (std::uint64_t done = 0;;) {
    // The words that hold the last bit of a short run may be the last ones.
    if (at + static_cast<std::uint64_t>(id_bits) + MaterialRun::kLastBits > end)
      fail_page(page, "ends after the last word");
    const bool is_last = read_bits(view.words, at + static_cast<std::uint64_t>(id_bits),
                                   MaterialRun::kLastBits) != 0;
    const std::uint64_t most_bits = static_cast<std::uint64_t>(id_bits) + MaterialRun::kLastBits +
                                    (is_last ? 0 : MaterialRun::kLengthBits);
    if (at + most_bits > end) fail_page(page, "ends after the last word");
    if (!is_last) {
      const std::uint64_t below = read_bits(view.words, at + most_bits - MaterialRun::kLengthBits,
                                            MaterialRun::kLengthBits);
      if (at + most_bits + below > end) fail_page(page, "ends after the last word");
    }
    const MaterialRun run = read_material_run(view, at, id_bits);
    if (run.id >= view.materials)
      fail_page(page,
                "has material " + std::to_string(run.id) + " of " + std::to_string(view.materials));
    if (run.id == before) fail_page(page, "has two runs of one material in succession");
    before = run.id;
    at += static_cast<std::uint64_t>(run.bits);
    if (is_last) return at;
    done += run.length;
    if (done >= values) fail_page(page, "has more than its " + std::to_string(values) + " cells");
  }
}

}  // namespace

void validate_material_ids(const MaterialIdsView& view) {
  if (view.materials < 1 || view.materials > kMaxMaterials)
    throw Error("", "",
                "has " + std::to_string(view.materials) + " materials: 1 to " +
                    std::to_string(kMaxMaterials) + " are allowed");
  validate_cell_pages(view, [&](std::uint64_t page, std::uint64_t at, std::uint64_t values) {
    return page_end(view, page, at, values);
  });
}

}  // namespace voxdag
