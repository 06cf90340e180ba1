/// The module that reads stacks of TIFF: the only part that links libtiff.
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/volumes/slice_files.hpp"

namespace voxdag {
namespace {

/// An open file. Errors of libtiff throw Error.
class TiffFile {
 public:
  explicit TiffFile(const std::filesystem::path& path) : path_(path.string()) {
    const MappedFile check(path, MappedFile::Access::kRandom);  // Throws the usual errors.
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
        TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxSliceBytes);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, this);
    TIFFOpenOptionsSetWarningHandlerExtR(
        options.get(), [](TIFF*, void*, const char*, const char*, va_list) { return 1; }, nullptr);
    // M: libtiff does not map the file. h: it reads the first header alone.
    tiff_.reset(TIFFOpenExt(path_.c_str(), "rM", options.get()));
    if (!tiff_) fail("cannot be read");
  }

  TIFF* get() const { return tiff_.get(); }
  const std::string& path() const { return path_; }
  /// Throws Error with libtiff's message.
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(path_, "", what + (message_.empty() ? "" : ": " + printable(message_)));
  }
  void expect(bool is_done, const std::string& what) const {
    if (!is_done) fail(what);
  }

 private:
  static int keep_message(TIFF*, void* file, const char*, const char* format, va_list values) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, values);
    std::string& message = static_cast<TiffFile*>(file)->message_;
    if (message.empty()) message = text;
    return 1;
  }

  std::string path_, message_;
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

/// The header of a page.
struct Page {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, photometric = 0, orientation = 1;
  bool has_alpha = false;

  bool operator==(const Page&) const = default;
  bool has_colors() const {
    return photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE;
  }
};

Page page_of(const TiffFile& file) {
  Page page;
  TIFF* const tiff = file.get();
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &page.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &page.orientation);
  std::uint16_t extras = 0;
  const std::uint16_t* kinds = nullptr;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extras, &kinds);
  page.has_alpha = extras > 0 && kinds[0] != EXTRASAMPLE_UNSPECIFIED;
  if (TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &page.photometric) == 0)
    file.fail("does not say what its values mean (PhotometricInterpretation)");
  if (page.format == SAMPLEFORMAT_VOID) page.format = SAMPLEFORMAT_UINT;
  return page;
}

/// Returns the type of the values of a page of one channel.
ValueType type_of(const TiffFile& file, const Page& page) {
  const auto is = [&](std::uint16_t format, int bits) {
    return page.format == format && page.bits == bits;
  };
  if (page.samples != 1)
    throw Error(file.path(), "header",
                "has " + std::to_string(page.samples) + " channels that are no colours");
  if (page.format == SAMPLEFORMAT_UINT && page.bits <= 8 &&
      (page.bits == 8 || page.bits == 4 || page.bits == 2 || page.bits == 1))
    return ValueType::kUint8;
  if (is(SAMPLEFORMAT_UINT, 16)) return ValueType::kUint16;
  if (is(SAMPLEFORMAT_UINT, 32)) return ValueType::kUint32;
  if (is(SAMPLEFORMAT_INT, 8)) return ValueType::kInt8;
  if (is(SAMPLEFORMAT_INT, 16)) return ValueType::kInt16;
  if (is(SAMPLEFORMAT_INT, 32)) return ValueType::kInt32;
  if (is(SAMPLEFORMAT_IEEEFP, 16)) return ValueType::kHalf;
  if (is(SAMPLEFORMAT_IEEEFP, 32)) return ValueType::kFloat;
  if (is(SAMPLEFORMAT_IEEEFP, 64)) return ValueType::kDouble;
  throw Error(file.path(), "header",
              "its values are neither integers of 1 to 32 bits nor real numbers of 16 to 64");
}

/// Returns the number after `key` in a text; nothing if there is none.
std::optional<double> number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  if (at == text.npos) return std::nullopt;
  const char* const begin = text.c_str() + at + key.size();
  char* end = nullptr;
  const double value = std::strtod(begin, &end);
  if (end == begin) return std::nullopt;
  return value;
}

/// The number and the spacing of a stack's slices, as ImageJ and OME write them.
struct Description {
  std::uint64_t slices = 1;
  bool has_slices = false;
  std::optional<Vec3d> spacing;
};

Description describe(const TiffFile& file) {
  Description result;
  const char* given = nullptr;
  if (TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &given) == 0 || given == nullptr)
    return result;
  const std::string text = given;
  const bool is_imagej = text.starts_with("ImageJ="), is_ome = text.find("<OME") != text.npos;
  if (!is_imagej && !is_ome) return result;
  const auto value = [&](std::string_view imagej, std::string_view ome) {
    std::string key = is_imagej ? "\n" : " ";
    key += is_imagej ? imagej : ome;
    key += is_imagej ? "=" : "=\"";
    return number_after(text, key);
  };
  const auto expect_one = [&](const char* imagej, const char* ome) {
    const double count = value(imagej, ome).value_or(1);
    if (count > 1)
      throw Error(file.path(), "header",
                  "has " + std::to_string(static_cast<long>(count)) + " " + imagej +
                      ", and a volume needs one: save one of them");
  };
  expect_one("channels", "SizeC");
  expect_one("frames", "SizeT");
  if (const auto count = value("images", "SizeZ"); count && *count >= 1 && *count <= 1 << 20) {
    result.slices = static_cast<std::uint64_t>(*count);
    result.has_slices = true;
  }
  if (is_imagej) {
    // ImageJ gives the distance of slices, and pixels per unit.
    float x = 0, y = 0;
    const auto z = value("spacing", "");
    if (z && TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &x) != 0 &&
        TIFFGetField(file.get(), TIFFTAG_YRESOLUTION, &y) != 0 && x > 0 && y > 0)
      result.spacing = Vec3d{1 / static_cast<double>(x), 1 / static_cast<double>(y), std::abs(*z)};
  } else {
    const auto x = value("", "PhysicalSizeX"), y = value("", "PhysicalSizeY"),
               z = value("", "PhysicalSizeZ");
    if (x && y && z) result.spacing = Vec3d{*x, *y, *z};
  }
  return result;
}

/// The pages of a file, or of the files of a folder.
class TiffPages {
 public:
  TiffPages(const std::filesystem::path& path, bool is_folder) {
    if (is_folder) {
      for (const std::string& name : names_of_slices(path, [](const std::string& name) {
             return lower_case(name).ends_with(".tif") || lower_case(name).ends_with(".tiff");
           }))
        files_.push_back(path / name);
    } else {
      files_.push_back(path);
    }
    open(0);
    page_ = page_of(*file_);
    if (page_.width == 0 || page_.height == 0) file_->fail("has no image");
    description_ = describe(*file_);
    if (is_folder) return;
    for (bool is_last = false; !is_last;) {
      std::uint32_t kind = 0;
      TIFFGetField(file_->get(), TIFFTAG_SUBFILETYPE, &kind);
      if ((kind & FILETYPE_REDUCEDIMAGE) == 0) {  // no smaller copy of another page
        check_page(offsets_.size());
        offsets_.push_back(TIFFCurrentDirOffset(file_->get()));
      }
      is_last = TIFFLastDirectory(file_->get()) != 0;
      file_->expect(is_last || TIFFReadDirectory(file_->get()) != 0,
                    "page " + std::to_string(offsets_.size() + 1) + " cannot be read");
    }
    if (offsets_.empty()) file_->fail("has no page");
    if (description_.has_slices && description_.slices != offsets_.size()) find_raw_slices();
  }

  std::uint64_t count() const {
    return raw_count_ != 0 ? raw_count_ : is_folder() ? files_.size() : offsets_.size();
  }
  bool is_folder() const { return offsets_.empty(); }
  const std::vector<std::filesystem::path>& files() const { return files_; }
  const TiffFile& first() const { return *file_; }
  const Page& page() const { return page_; }
  const std::optional<Vec3d>& spacing() const { return description_.spacing; }

  /// Fills the span with page z.
  void read(std::uint64_t z, std::span<std::byte> bytes) {
    if (raw_count_ != 0) return read_raw(z, bytes);
    if (is_folder()) {
      open(static_cast<std::size_t>(z));
      check_page(z);
    } else {
      file_->expect(TIFFSetSubDirectory(file_->get(), offsets_[static_cast<std::size_t>(z)]) != 0,
                    "page " + std::to_string(z + 1) + " cannot be read");
    }
    if (page_.has_colors())
      read_colors(bytes);
    else if (TIFFIsTiled(file_->get()) != 0)
      read_tiles(bytes);
    else
      read_rows(bytes);
    if (page_.photometric == PHOTOMETRIC_MINISWHITE) invert(bytes);
  }

 private:
  void open(std::size_t file) {
    if (file_ && file == open_) return;
    file_ = std::make_unique<TiffFile>(files_[file]);
    open_ = file;
  }

  void check_page(std::uint64_t number) const {
    if (page_of(*file_) != page_)
      throw Error(file_->path(), "",
                  is_folder() && number > 0 ? "differs from the first slice in size or type"
                                            : "page " + std::to_string(number + 1) +
                                                  " differs from the first one in size or type");
  }

  /// Finds the slices of a stack of more than 4 GiB of ImageJ: one page, and the slices after it.
  void find_raw_slices() {
    TIFF* const tiff = file_->get();
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    const std::uint64_t *strips = nullptr, slice = std::uint64_t{page_.width} * page_.height *
                                                   page_.samples * page_.bits / 8;
    if (offsets_.size() == 1 && compression == COMPRESSION_NONE && page_.bits % 8 == 0 &&
        !page_.has_colors() && TIFFGetField(tiff, TIFFTAG_STRIPOFFSETS, &strips) != 0 &&
        strips != nullptr) {
      raw_ = std::make_unique<MappedFile>(files_[0], MappedFile::Access::kSequential);
      const std::uint64_t size = raw_->bytes().size();
      if (strips[0] <= size && (size - strips[0]) / slice >= description_.slices) {
        raw_begin_ = strips[0];
        raw_count_ = description_.slices;
        return;
      }
    }
    throw Error(file_->path(), "header",
                "names " + std::to_string(description_.slices) + " slices, but has " +
                    std::to_string(offsets_.size()));
  }

  void read_raw(std::uint64_t z, std::span<std::byte> bytes) const {
    std::memcpy(bytes.data(), raw_->bytes().data() + raw_begin_ + z * bytes.size(), bytes.size());
    const std::size_t size = page_.bits / 8u;
    if (TIFFIsByteSwapped(file_->get()) != 0)
      for (std::size_t i = 0; i < bytes.size(); i += size)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                     bytes.begin() + static_cast<std::ptrdiff_t>(i + size));
    if (page_.photometric == PHOTOMETRIC_MINISWHITE) invert(bytes);
  }

  void read_colors(std::span<std::byte> bytes) const {
    std::vector<std::uint32_t> pixels(std::size_t{page_.width} * page_.height);
    file_->expect(TIFFReadRGBAImageOriented(file_->get(), page_.width, page_.height, pixels.data(),
                                            ORIENTATION_TOPLEFT, 1) != 0,
                  "its pixels cannot be read");
    const std::size_t channels = bytes.size() / pixels.size();
    for (std::size_t i = 0; i < pixels.size(); ++i)
      for (std::size_t c = 0; c < channels; ++c)
        bytes[i * channels + c] = static_cast<std::byte>(pixels[i] >> (8 * c));
  }

  /// Copies values of a row; values of less than 8 bits become bytes.
  void unpack(const std::byte* row, std::size_t count, std::byte* out) const {
    if (page_.bits >= 8) {
      std::memcpy(out, row, count * (page_.bits / 8u));
      return;
    }
    const std::size_t bits = page_.bits;
    for (std::size_t i = 0; i < count; ++i)
      out[i] = row[i * bits / 8] >> (8 - bits - i * bits % 8) & std::byte((1u << bits) - 1);
  }

  void read_rows(std::span<std::byte> bytes) const {
    std::vector<std::byte> row(static_cast<std::size_t>(TIFFScanlineSize64(file_->get())));
    const std::size_t row_bytes = bytes.size() / page_.height;
    if (row.size() < (std::size_t{page_.width} * page_.bits + 7) / 8) file_->fail("has short rows");
    for (std::uint32_t y = 0; y < page_.height; ++y) {
      file_->expect(TIFFReadScanline(file_->get(), row.data(), y) >= 0,
                    "its pixels cannot be read");
      unpack(row.data(), page_.width, bytes.data() + y * row_bytes);
    }
  }

  void read_tiles(std::span<std::byte> bytes) const {
    std::uint32_t width = 0, height = 0;
    TIFFGetField(file_->get(), TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(file_->get(), TIFFTAG_TILELENGTH, &height);
    std::vector<std::byte> tile(static_cast<std::size_t>(TIFFTileSize64(file_->get())));
    const std::size_t tile_row = static_cast<std::size_t>(TIFFTileRowSize64(file_->get()));
    const std::size_t value = bytes.size() / (std::size_t{page_.width} * page_.height);
    if (width == 0 || height == 0 || tile.size() < tile_row * height ||
        tile_row < (std::size_t{width} * page_.bits + 7) / 8)
      file_->fail("has no sensible tiles");
    for (std::uint32_t y = 0; y < page_.height; y += height)
      for (std::uint32_t x = 0; x < page_.width; x += width) {
        file_->expect(TIFFReadTile(file_->get(), tile.data(), x, y, 0, 0) >= 0,
                      "its pixels cannot be read");
        const std::size_t count = std::min(width, page_.width - x);
        for (std::uint32_t row = 0; row < std::min(height, page_.height - y); ++row)
          unpack(tile.data() + row * tile_row, count,
                 bytes.data() + (std::size_t{y + row} * page_.width + x) * value);
      }
  }

  void invert(std::span<std::byte> bytes) const {
    const auto all = static_cast<std::byte>(page_.bits >= 8 ? 0xFF : (1 << page_.bits) - 1);
    if (page_.format == SAMPLEFORMAT_UINT)
      for (std::byte& byte : bytes) byte ^= all;
  }

  std::vector<std::filesystem::path> files_;
  std::vector<std::uint64_t> offsets_;  ///< Of the pages of the only file.
  std::unique_ptr<TiffFile> file_;
  std::size_t open_ = 0;
  Page page_;
  Description description_;
  std::unique_ptr<MappedFile> raw_;  ///< Slices without pages.
  std::uint64_t raw_begin_ = 0, raw_count_ = 0;
};

VoxelSource* open_tiff_in_module(const std::filesystem::path& path, std::optional<double> threshold,
                                 bool has_labels, const std::vector<ChannelRequest>& channels) {
  const auto pages = std::make_shared<TiffPages>(path, std::filesystem::is_directory(path));
  const Page& page = pages->page();
  DenseFile stack;
  stack.path = path;
  stack.encoding = Encoding::kSlices;
  stack.channels = channels;
  stack.volume.size = {page.width, page.height, pages->count()};
  stack.volume.threshold = threshold;
  stack.volume.has_labels = has_labels;
  if (page.has_colors())
    stack.volume.channels = page.has_alpha ? 4 : 3;
  else
    stack.volume.type = type_of(pages->first(), page);
  check_volume_size(path, stack.volume.size);
  if (pages->is_folder()) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : pages->files())
      names.push_back(file.filename().string());
    if (const std::string missing = missing_slices(names); !missing.empty())
      stack.warnings.push_back(missing);
  }
  if (!page.has_colors() && page.orientation != ORIENTATION_TOPLEFT)
    stack.warnings.push_back(
        "rows are read from the top and columns from the left, although the orientation is " +
        std::to_string(page.orientation));
  VolumePlacement placement;
  if (const std::optional<Vec3d>& spacing = pages->spacing()) {
    placement.steps = {Vec3d{spacing->x, 0, 0}, Vec3d{0, spacing->y, 0}, Vec3d{0, 0, spacing->z}};
    placement.is_known = stack.has_place = true;
  }
  stack.map = VolumeMap(path, stack.volume.size, placement, stack.warnings);
  stack.read_slice = [pages](std::uint64_t z, std::span<std::byte> bytes) {
    pages->read(z, bytes);
  };
  return make_dense_source(std::move(stack)).release();
}

}  // namespace
}  // namespace voxdag

extern "C" const voxdag::SliceModule voxdag_tiff_module = {voxdag::open_tiff_in_module};
