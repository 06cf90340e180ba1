#pragma once
/// Reads XML with expat, one element after the other, within limits.
#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

/// The attributes of an element, valid during XmlHandler::open().
class XmlAttributes {
 public:
  explicit XmlAttributes(const char** names_and_values) : pairs_(names_and_values) {}
  /// Returns the value of an attribute, whatever the prefix of its name; empty if there is none.
  std::string_view operator[](std::string_view name) const;
  /// Calls fn(name, value) for all attributes.
  template <class Fn>
  void for_each(const Fn& fn) const {
    for (const char** pair = pairs_; *pair != nullptr; pair += 2) fn(local(pair[0]), pair[1]);
  }
  /// Returns a name without its prefix.
  static std::string_view local(std::string_view name) {
    return name.substr(name.find(':') + 1);  // npos + 1 is 0.
  }

 private:
  const char** pairs_;
};

/// Receives elements. Names have no prefixes. Functions may throw: an Error without a file gets
/// the file and the line.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual void open(std::string_view name, const XmlAttributes& attributes) = 0;
  virtual void close(std::string_view name) = 0;
  /// Receives a part of the text of the element that is open.
  virtual void text(std::string_view) {}
};

/// Parses a document that comes in parts. Refuses document types, so no entity of the document's
/// own is ever expanded; elements that are nested more than 200 deep; and names and attributes of
/// more than a mebibyte. So memory does not grow with the document.
class XmlParser {
 public:
  /// `part` names the document in a file that holds several; may be empty.
  XmlParser(const MeshSource& source, std::string part, XmlHandler& handler);
  ~XmlParser();
  XmlParser(const XmlParser&) = delete;
  XmlParser& operator=(const XmlParser&) = delete;

  /// Parses more bytes. Throws Error(file, line, reason), what the handler throws, and Cancelled.
  void parse(std::string_view bytes);
  /// Throws if the document is not complete.
  void finish();

 private:
  struct Expat;
  void parse_step(std::string_view bytes, bool is_last);
  ErrorPlace here() const;

  const MeshSource& source_;
  std::string part_;
  XmlHandler& handler_;
  std::exception_ptr failure_;
  int depth_ = 0;
  std::uint64_t fed_ = 0;  ///< Bytes that expat has.
  std::unique_ptr<Expat> expat_;
};

}  // namespace voxdag
