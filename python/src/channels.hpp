#pragma once
/// Channels in arguments of Python.
#include <pybind11/pybind11.h>

#include <optional>
#include <vector>

#include "arrays.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag::python {

/// Channels of places, and their values: for each place one of each channel.
struct ChannelRows {
  std::vector<ChannelSpec> specs;
  std::vector<double> values;
};

/// The argument `channels` of functions that take arrays: a dict from names to arrays, or to pairs
/// of an array and a bound.
using ChannelsArgument = std::optional<pybind11::dict>;

/// Returns the channels. Their arrays have the shape of `shape_of`, or one value for each of `rows`
/// places; the places of the rows are `picks` in these arrays, in C order, or all. Raises
/// ValueError and TypeError for others.
ChannelRows channel_rows(const ChannelsArgument& channels,
                         const std::vector<pybind11::ssize_t>& shape,
                         const std::vector<std::size_t>* picks = nullptr);

/// Returns the requests of import_file(): a list of names of fields, or a dict from names of
/// channels to names of fields, or to pairs of a field and a bound.
std::vector<ChannelRequest> channel_requests(const pybind11::object& channels);

}  // namespace voxdag::python
