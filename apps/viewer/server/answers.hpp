#pragma once
/// Answers requests for the files of the page and for one scene.
#include <httplib.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/embedded/page_files.hpp"
#include "viewer/scene/scene_bytes.hpp"
#include "viewer/server/edit_answers.hpp"
#include "viewer/server/multipart_body.hpp"

namespace voxdag {

/// How the server sends a file of the page: the entity tag of its bytes, and its bytes compressed
/// by gzip.
struct PageFileAnswer {
  PageFile file;
  std::string tag;
  std::string gzip;  ///< Empty if it would not be smaller.
  std::string gzip_tag;
};

/// Answers GET and HEAD of the page's files and of /scene.vdag, which is `scene`, with ranges and
/// entity tags. The answer to other paths is 404, to other methods 405. Thread-safe; plan() and
/// answer() of a request must run on one thread.
class Answers {
 public:
  /// If `local_host` is not empty, requests are refused unless their Host is this name or a name of
  /// the loopback interface. `scene` and `files` must outlive this object.
  Answers(const SceneBytes& scene, std::span<const PageFile> files, const std::string& local_host);

  /// Answers the requests of EditAnswers, too. Call it before the first request.
  void take_edits(EditSession& session, const std::string& token) {
    edits_.emplace(session, token);
  }

  /// Returns the header fields of every answer.
  static const httplib::Headers& default_headers();

  /// Takes the ranges out of the request, so that the HTTP library applies none itself, and keeps
  /// them for answer() if they apply. Call it before answer().
  void plan(httplib::Request& request) const;
  void answer(const httplib::Request& request, httplib::Response& response) const;

 private:
  bool is_allowed_host(const httplib::Request& request) const;
  void answer_page(const PageFileAnswer& file, const httplib::Request& request,
                   httplib::Response& response) const;
  void answer_scene(const httplib::Request& request, httplib::Response& response) const;
  void answer_parts(const std::vector<ByteRange>& ranges, httplib::Response& response) const;

  const SceneBytes& scene_;
  const std::string local_host_, scene_tag_;
  std::map<std::string_view, PageFileAnswer> page_;  ///< By the path of the page's file.
  std::optional<EditAnswers> edits_;
};

}  // namespace voxdag
