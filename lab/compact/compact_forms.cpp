#include "lab/compact/compact_forms.hpp"

#include <array>

#include "lab/compact/plain_sizes.hpp"
#include "lab/compact/ssvdag.hpp"
#include "lab/compact/tsvdag.hpp"
#include "lab/compact/voxdag_form.hpp"

namespace voxdag::lab {

std::span<const CompactForm> compact_forms() {
  static constexpr std::array kForms{
      CompactForm{"svo", "SVO", [](const SvdagView& dag, Progress&) { return svo_size(dag); },
                  false},
      CompactForm{"svdag", "SVDAG",
                  [](const SvdagView& dag, Progress&) { return svdag_size(dag); }},
      CompactForm{"ssvdag", "SSVDAG",
                  [](const SvdagView& dag, Progress& p) { return ssvdag_size(dag, p); }},
      CompactForm{
          "tsvdag", "TSVDAG",
          [](const SvdagView& dag, Progress& p) { return tsvdag_size(dag, kTsvdagMoveHeight, p); }},
      CompactForm{"voxdag", "voxdag",
                  [](const SvdagView& dag, Progress& p) { return voxdag_size(dag, p); }},
  };
  return kForms;
}

}  // namespace voxdag::lab
