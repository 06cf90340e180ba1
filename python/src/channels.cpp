/// Channels: their arguments, and the methods of Dag for them.
#include "channels.hpp"

#include <pybind11/stl.h>

#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

/// Returns the kind of channel for the numbers of an array: the smallest that has all of them.
/// Those of 32 and 64 bits are i32, which refuses others.
ChannelKind kind_of_array(const py::array& array, const char* name) {
  const char kind = kind_of(array, name, "biuf", "numbers");
  if (kind == 'f') return ChannelKind::kF32;
  if (kind == 'b' || (kind == 'u' && array.itemsize() == 1)) return ChannelKind::kU8;
  if (array.itemsize() > 2) return ChannelKind::kI32;
  return kind == 'u' && array.itemsize() == 2 ? ChannelKind::kU16 : ChannelKind::kI16;
}

/// Splits a value, or a pair of a value and a bound.
std::pair<py::object, double> with_bound(const py::handle& given) {
  if (!py::isinstance<py::tuple>(given)) return {py::reinterpret_borrow<py::object>(given), 0};
  const auto pair = py::reinterpret_borrow<py::tuple>(given);
  if (pair.size() != 2) throw py::value_error("a channel is a value, or a pair with its bound");
  const auto bound = pair[1].cast<double>();
  if (!(bound > 0)) throw py::value_error("the bound of a channel must be positive");
  return {pair[0], bound};
}

/// Returns the channel with this name. Raises KeyError if there is none.
ChannelView channel_named(const Dag& dag, const std::string& name) {
  const ChannelsView channels = dag.model().attributes().channels;
  const std::size_t i = channels.find(name);
  if (i == channels.count()) {
    std::string names;
    for (std::size_t k = 0; k < channels.count(); ++k)
      names += (k > 0 ? ", " : "") + std::string(channels[k].name());
    throw py::value_error("the DAG has no channel " + name +
                          (names.empty() ? "" : "; it has " + names));
  }
  return channels[i];
}

py::object channel(const Dag& dag, const std::string& name, const std::optional<ArrayLike>& given) {
  const ChannelView view = channel_named(dag, name);
  const ColoredDagView colored{dag.view(), dag.model().attributes()};
  std::vector<double> values;
  const auto read = [&](Vec3i voxel) {
    std::uint64_t number = 0;
    const bool is_voxel = find_number(colored, voxel, dag.grid().levels, number);
    if (!is_voxel && given)
      throw py::value_error("voxels has a place where no voxel is: (" + std::to_string(voxel.x) +
                            ", " + std::to_string(voxel.y) + ", " + std::to_string(voxel.z) + ")");
    values.push_back(view.read(number));
  };
  if (given)
    for (const Vec3i voxel : voxels_of(*given, "voxels")) read(voxel);
  else
    run_work([&](Work work) {
      for_each_voxel(dag.view(), whole_grid(dag.grid().levels), [&](Vec3i voxel) {
        work.poll_seldom(values.size());
        read(voxel);
      });
      return 0;
    });
  return with_kind(view.kind, [&]<class T>(T) -> py::array {
    return array_of(std::vector<T>(values.begin(), values.end()));
  });
}

py::list channel_list(const Dag& dag) {
  py::list list;
  const ChannelsView channels = dag.model().attributes().channels;
  for (std::size_t i = 0; i < channels.count(); ++i) {
    const ChannelView view = channels[i];
    const ChannelRange range = range_of(view);
    py::dict row;
    row["name"] = std::string(view.name());
    row["kind"] = name_of(view.kind);
    row["bound"] = view.bound;
    row["least"] = range.least;
    row["greatest"] = range.most;
    list.append(row);
  }
  return list;
}

}  // namespace

ChannelRows channel_rows(const ChannelsArgument& channels, const std::vector<py::ssize_t>& shape,
                         const std::vector<std::size_t>* picks) {
  ChannelRows rows;
  if (!channels) return rows;
  std::vector<Array<double>> columns;
  for (const auto& [key, given] : *channels) {
    const std::string name = py::cast<std::string>(key);
    const auto [value, bound] = with_bound(given);
    const auto array = value.cast<ArrayLike>();
    if (std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) != shape)
      throw py::value_error(
          "the channel " + name + " must have the shape " +
          (shape.size() == 1 ? "(N,), with a value for each point" : "of the dense array"));
    rows.specs.push_back(
        {name, bound > 0 ? ChannelKind::kF32 : kind_of_array(array, name.c_str()), bound});
    check_channel(rows.specs.back());
    columns.emplace_back(array);
  }
  if (columns.empty()) return rows;
  const std::size_t count =
      picks != nullptr ? picks->size() : static_cast<std::size_t>(columns[0].size());
  for (std::size_t i = 0; i < count; ++i)
    for (const Array<double>& column : columns)
      rows.values.push_back(column.data()[picks != nullptr ? (*picks)[i] : i]);
  return rows;
}

std::vector<ChannelRequest> channel_requests(const py::object& channels) {
  std::vector<ChannelRequest> requests;
  if (channels.is_none()) return requests;
  if (py::isinstance<py::str>(channels)) return {{channels.cast<std::string>(), {}}};
  if (!py::isinstance<py::dict>(channels)) {
    for (const py::handle field : channels) requests.push_back({py::cast<std::string>(field), {}});
    return requests;
  }
  for (const auto& [name, given] : channels.cast<py::dict>()) {
    const auto [field, bound] = with_bound(given);
    requests.push_back({field.cast<std::string>(), py::cast<std::string>(name), bound});
  }
  return requests;
}

void add_channels(DagClass& dag) {
  dag.def_property_readonly("channels", &channel_list,
                            "The channels, a list of dicts: name, kind ('u8', 'u16', 'i16', 'i32' "
                            "or 'f32'), bound (the largest error of a value; 0: none), least and "
                            "greatest (of the values).")
      .def("channel", &channel, py::arg("name"), py::arg("voxels") = py::none(),
           R"(Returns a channel of voxels, (N,) numbers of its kind.

name: of the channel.
voxels: (N, 3) whole numbers; default: coords(). Raises ValueError if the DAG has no such channel, and
for places without a voxel.)");
}

}  // namespace voxdag::python
