#include "viewer/server/answers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "viewer/gzip/gzip.hpp"
#include "viewer/server/entity_tags.hpp"
#include "viewer/server/multipart_body.hpp"
#include "viewer/server/server_address.hpp"

namespace voxdag {
namespace {

constexpr char kScenePath[] = "/scene.vdag";
constexpr char kSceneType[] = "application/octet-stream";

/// The parts of the scene that a request asks for.
struct PlannedRanges {
  bool are_wrong = false;         ///< No range can be served.
  std::vector<ByteRange> ranges;  ///< As resolve_ranges() makes them; none: the whole scene.
};

/// Passes the ranges of a request from plan() to answer(). The HTTP library calls both on the
/// thread that serves the request, and has no place for them in the request itself.
thread_local PlannedRanges planned_ranges;

bool is_for_scene(const httplib::Request& request) { return request.path == kScenePath; }

/// Sets the entity tag. If the client has these bytes already, sets the status 304 and returns
/// true.
bool answer_known(const httplib::Request& request, httplib::Response& response,
                  const std::string& tag) {
  response.set_header("ETag", tag);
  if (!has_tag(request.get_header_value("If-None-Match"), tag)) return false;
  response.status = 304;
  return true;
}

/// Returns whether the value of Accept-Encoding allows gzip.
bool accepts_gzip(std::string_view field) {
  while (!field.empty()) {
    const std::size_t end = std::min(field.find(','), field.size());
    std::string_view entry = field.substr(0, end);
    field.remove_prefix(std::min(end + 1, field.size()));
    entry.remove_prefix(std::min(entry.find_first_not_of(" \t"), entry.size()));
    const std::size_t name_end = std::min(entry.find_first_of(" \t;"), entry.size());
    if (entry.substr(0, name_end) != "gzip") continue;
    // A quality of zero forbids it: "gzip;q=0", "gzip; q=0.000".
    const std::size_t quality = entry.find("q=");
    return quality == std::string_view::npos ||
           entry.substr(quality + 2).find_first_not_of("0. \t") != std::string_view::npos;
  }
  return false;
}

void refuse(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

/// Makes a response of `size` bytes, which read(offset, span) provides piece by piece.
template <class Read>
void give(httplib::Response& response, std::uint64_t size, const std::string& type,
          const Read& read) {
  if (size == 0) return response.set_content("", type);
  response.set_content_provider(
      size, type, [read](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        constexpr std::size_t kPiece = 65536;
        std::vector<std::byte> piece(std::min(length, kPiece));
        return read(offset, std::span<std::byte>(piece)) &&
               sink.write(reinterpret_cast<const char*>(piece.data()), piece.size());
      });
}

}  // namespace

const httplib::Headers& Answers::default_headers() {
  static const httplib::Headers headers = {
      // Nor may other sites show the page in a frame.
      {"Content-Security-Policy", std::string(kPagePolicy) + "; frame-ancestors 'self'"},
      // Browsers believe the types that the server says, and run no other file as a script.
      {"X-Content-Type-Options", "nosniff"},
      // Other sites can neither embed the scene nor get a handle of the page's window.
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Embedder-Policy", "require-corp"},
      {"Referrer-Policy", "no-referrer"},
      // Browsers keep copies, but ask each time whether the copies are still right.
      {"Cache-Control", "no-cache"}};
  return headers;
}

Answers::Answers(const SceneBytes& scene, std::span<const PageFile> files,
                 const std::string& local_host)
    : scene_(scene), local_host_(local_host), scene_tag_(quoted_tag(scene.tag())) {
  for (const PageFile& file : files) {
    PageFileAnswer& encodings = page_[file.path];
    encodings.file = file;
    encodings.tag = tag_of(file.bytes);
    std::string compressed = gzip(file.bytes);
    if (compressed.size() >= file.bytes.size()) continue;
    encodings.gzip_tag = tag_of(compressed);
    encodings.gzip = std::move(compressed);
  }
}

void Answers::plan(httplib::Request& request) const {
  planned_ranges = {};
  std::vector<ByteRange> ranges;
  std::swap(ranges, request.ranges);
  const std::string if_range = request.get_header_value("If-Range");
  if (ranges.empty() || request.method != "GET" || !is_for_scene(request) ||
      (!if_range.empty() && if_range != scene_tag_))
    return;
  planned_ranges.are_wrong = !resolve_ranges(ranges, scene_.size());
  planned_ranges.ranges = std::move(ranges);
}

bool Answers::is_allowed_host(const httplib::Request& request) const {
  if (local_host_.empty()) return true;
  const std::string host = host_of(request.get_header_value("Host"));
  return host == "localhost" || host == "127.0.0.1" || host == "[::1]" || host == local_host_;
}

void Answers::answer(const httplib::Request& request, httplib::Response& response) const {
  if (!is_allowed_host(request))
    return refuse(response, 403, "this server answers only for localhost");
  if (edits_ && EditAnswers::takes(request)) return edits_->answer(request, response);
  if (request.method != "GET" && request.method != "HEAD") {
    response.set_header("Allow", "GET, HEAD");
    return refuse(response, 405, "only GET and HEAD");
  }
  if (is_for_scene(request)) return answer_scene(request, response);
  const std::string_view path = request.path;
  const auto file =
      path.starts_with("/") ? page_.find(path == "/" ? "index.html" : path.substr(1)) : page_.end();
  if (file == page_.end()) return refuse(response, 404, "not found");
  answer_page(file->second, request, response);
}

void Answers::answer_page(const PageFileAnswer& encodings, const httplib::Request& request,
                          httplib::Response& response) const {
  const bool is_compressed =
      !encodings.gzip.empty() && accepts_gzip(request.get_header_value("Accept-Encoding"));
  response.set_header("Vary", "Accept-Encoding");
  if (is_compressed) response.set_header("Content-Encoding", "gzip");
  if (answer_known(request, response, is_compressed ? encodings.gzip_tag : encodings.tag)) return;
  const std::string_view bytes =
      is_compressed ? std::string_view(encodings.gzip) : encodings.file.bytes;
  give(response, bytes.size(), std::string(encodings.file.type),
       [bytes](std::uint64_t offset, auto out) {
         std::copy_n(std::as_bytes(std::span(bytes)).begin() + static_cast<std::ptrdiff_t>(offset),
                     out.size(), out.begin());
         return true;
       });
}

void Answers::answer_scene(const httplib::Request& request, httplib::Response& response) const {
  if (!scene_.is_unchanged())
    return refuse(response, 500,
                  "the scene's file has changed since the server opened it: start it again");
  response.set_header("Accept-Ranges", "bytes");
  if (answer_known(request, response, scene_tag_)) return;
  if (planned_ranges.are_wrong) {
    response.set_header("Content-Range", fmt::format("bytes */{}", scene_.size()));
    response.status = 416;
    return;
  }
  const std::vector<ByteRange>& ranges = planned_ranges.ranges;
  if (!ranges.empty()) response.status = 206;
  if (ranges.size() > 1) return answer_parts(ranges, response);
  std::uint64_t begin = 0, size = scene_.size();
  if (!ranges.empty()) {
    const auto [first, last] = ranges[0];
    response.set_header("Content-Range", fmt::format("bytes {}-{}/{}", first, last, scene_.size()));
    begin = static_cast<std::uint64_t>(first);
    size = static_cast<std::uint64_t>(last - first) + 1;
  }
  give(response, size, kSceneType,
       [this, begin](std::uint64_t offset, auto out) { return scene_.read(begin + offset, out); });
}

void Answers::answer_parts(const std::vector<ByteRange>& ranges,
                           httplib::Response& response) const {
  const std::string boundary = "voxdag-range-" + scene_.tag();
  const auto body = std::make_shared<MultipartBody>(scene_, ranges, kSceneType, boundary);
  give(response, body->size(), "multipart/byteranges; boundary=" + boundary,
       [body](std::uint64_t offset, auto out) { return body->read(offset, out); });
}

}  // namespace voxdag
