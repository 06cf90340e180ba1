#pragma once
/// Answers the requests of the page that edits the scene.
#include <httplib.h>

#include <string>

#include "viewer/edit/edit_session.hpp"

namespace voxdag {

/// Returns 128 bits of the system's random numbers, as hexadecimal digits.
std::string make_token();

/// Answers POST of these paths, with the bytes of an EditUpdate:
///
///   /edit/open              makes the page the one that edits
///   /edit/stroke[?more]     edits: lines of a script; `more` goes on with the stroke before
///   /edit/undo, /edit/redo
///   /edit/file              answers with the name that saving suggests
///   /edit/save[?replace]    saves to the file that the body names; answers with its name
///
/// A request needs the fields Voxdag-Token, with the secret of the page's address, and Origin, with
/// the origin of this server: browsers set it to that of the page that asks. Those that edit or
/// save need Voxdag-Writer, the number from open. The answer is 403 without token and origin, 409
/// for a page that does not edit any more, 412 for a file that exists, 400 for other errors, each
/// with a line of text. Thread-safe.
class EditAnswers {
 public:
  /// `session` must outlive this object.
  EditAnswers(EditSession& session, std::string token)
      : session_(session), token_(std::move(token)) {}

  /// Returns whether it answers the request.
  static bool takes(const httplib::Request& request) {
    return request.method == "POST" && request.path.starts_with("/edit/");
  }
  void answer(const httplib::Request& request, httplib::Response& response) const;

 private:
  bool is_allowed(const httplib::Request& request) const;
  /// Returns false for an unknown path.
  bool answer_edit(const httplib::Request& request, httplib::Response& response) const;

  EditSession& session_;
  const std::string token_;
};

}  // namespace voxdag
