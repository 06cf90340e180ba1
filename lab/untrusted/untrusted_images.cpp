// Hostile textures: files that decode to many times their size.
#include <fmt/format.h>
#include <png.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

// jpeglib.h must come after <cstdio>, which it needs.
#include <jpeglib.h>

#include "lab/untrusted/untrusted_case.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File create(const fs::path& path) {
  File file(std::fopen(path.c_str(), "wb"));
  if (file == nullptr) throw Error(path.string(), "", "cannot create");
  return file;
}

void write_textured_triangle(const fs::path& folder, const std::string& texture) {
  std::ofstream(folder / "triangle.obj")
      << "mtllib triangle.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
         "f 1/1 2/2 3/3\n";
  std::ofstream(folder / "triangle.mtl") << "newmtl a\nmap_Kd " << texture << "\n";
}

/// Writes a PNG of 16,384² black pixels of one bit: about 33 KB.
void write_one_bit_png(const fs::path& folder) {
  constexpr png_uint_32 kSide = 16384;
  write_textured_triangle(folder, "black.png");
  const File file = create(folder / "black.png");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file.get());
  png_set_IHDR(png, info, kSide, kSide, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 9);
  png_write_info(png, info);
  const std::vector<png_byte> row(kSide / 8);
  for (png_uint_32 y = 0; y < kSide; ++y) png_write_row(png, row.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
}

/// Writes a sparse file of 3 GiB that starts like a PNG; its holes need no disk space.
void write_sparse_png(const fs::path& folder) {
  write_textured_triangle(folder, "sparse.png");
  std::ofstream(folder / "sparse.png") << "none";
  fs::resize_file(folder / "sparse.png", std::uint64_t{3} << 30);
}

/// Writes a progressive JPEG of 8,192² grey pixels in 190 scans, each of one coefficient and one
/// bit.
void write_scan_jpeg(const fs::path& folder) {
  constexpr JDIMENSION kSide = 8192;
  write_textured_triangle(folder, "scans.jpg");
  const File file = create(folder / "scans.jpg");
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  jpeg_stdio_dest(&jpeg, file.get());
  jpeg.image_width = jpeg.image_height = kSide;
  jpeg.input_components = 1;
  jpeg.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg.optimize_coding = TRUE;
  std::vector<jpeg_scan_info> scans;
  scans.push_back({1, {0}, 0, 0, 0, 0});
  for (int coefficient = 1; coefficient < 64; ++coefficient) {
    scans.push_back({1, {0}, coefficient, coefficient, 0, 2});
    scans.push_back({1, {0}, coefficient, coefficient, 2, 1});
    scans.push_back({1, {0}, coefficient, coefficient, 1, 0});
  }
  jpeg.scan_info = scans.data();
  jpeg.num_scans = static_cast<int>(scans.size());
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(kSide, 128);
  JSAMPROW rows[1] = {row.data()};
  while (jpeg.next_scanline < kSide) jpeg_write_scanlines(&jpeg, rows, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
}

}  // namespace

std::vector<UntrustedCase> untrusted_image_cases() {
  const std::vector<std::string> build{"build",  "triangle.obj", "-r",       "256", "-o",
                                       "x.esvo", "--quiet",      "--memory", "100M"};
  return {
      {"PNG: 16,384² pixels in 33 KB", write_one_bit_png, {}, build, 100 * kMebibyte},
      {"PNG: 3 GiB of zeros", write_sparse_png, {}, build, 100 * kMebibyte},
      {"JPEG: 190 scans", write_scan_jpeg, {}, build, 100 * kMebibyte},
  };
}

}  // namespace voxdag::lab
