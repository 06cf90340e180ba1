#include "voxdag/formats/readers/xml/xml_parser.hpp"

#include <expat.h>

#include <algorithm>
#include <new>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {
namespace {

constexpr int kMaxXmlDepth = 200;
constexpr std::size_t kStepBytes = std::size_t{1} << 16;
constexpr std::uint64_t kMaxTokenBytes = std::uint64_t{1} << 20;

}  // namespace

std::string_view XmlAttributes::operator[](std::string_view name) const {
  std::string_view found;
  for_each([&](std::string_view key, std::string_view value) {
    if (key == name) found = value;
  });
  return found;
}

struct XmlParser::Expat {
  XML_Parser parser;

  explicit Expat(XmlParser* owner) : parser(XML_ParserCreate(nullptr)) {
    if (parser == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser, owner);
    XML_SetElementHandler(
        parser,
        [](void* user, const char* name, const char** attributes) {
          guard(user, [&](XmlParser& p) {
            if (++p.depth_ > kMaxXmlDepth) throw Error("elements are nested more than 200 deep");
            p.handler_.open(XmlAttributes::local(name), XmlAttributes(attributes));
          });
        },
        [](void* user, const char* name) {
          guard(user, [&](XmlParser& p) {
            --p.depth_;
            p.handler_.close(XmlAttributes::local(name));
          });
        });
    XML_SetCharacterDataHandler(parser, [](void* user, const char* text, int size) {
      guard(user, [&](XmlParser& p) { p.handler_.text({text, static_cast<std::size_t>(size)}); });
    });
    XML_SetStartDoctypeDeclHandler(
        parser, [](void* user, const char*, const char*, const char*, int) {
          guard(user, [](XmlParser&) { throw Error("has a document type, which is not read"); });
        });
  }
  Expat(const Expat&) = delete;
  Expat& operator=(const Expat&) = delete;
  ~Expat() { XML_ParserFree(parser); }

  /// Calls body(parser). Exceptions must not pass through expat, so it keeps them for parse_step().
  template <class Body>
  static void guard(void* user, const Body& body) {
    XmlParser& owner = *static_cast<XmlParser*>(user);
    if (owner.failure_) return;
    try {
      body(owner);
    } catch (...) {
      owner.failure_ = std::current_exception();
      XML_StopParser(owner.expat_->parser, XML_FALSE);
    }
  }
};

XmlParser::XmlParser(const MeshSource& source, std::string part, XmlHandler& handler)
    : source_(source), part_(std::move(part)), handler_(handler) {
  expat_ = std::make_unique<Expat>(this);
}

XmlParser::~XmlParser() = default;

ErrorPlace XmlParser::here() const {
  return ErrorPlace(part_) / ErrorPlace::line(XML_GetCurrentLineNumber(expat_->parser));
}

void XmlParser::parse(std::string_view bytes) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kStepBytes, bytes.size())))
    parse_step(bytes.substr(0, kStepBytes), false);
}

void XmlParser::finish() { parse_step({}, true); }

void XmlParser::parse_step(std::string_view bytes, bool is_last) {
  source_.work().poll();
  const XML_Status status = XML_Parse(expat_->parser, bytes.data(), static_cast<int>(bytes.size()),
                                      is_last ? XML_TRUE : XML_FALSE);
  fed_ += bytes.size();
  if (failure_) {
    try {
      std::rethrow_exception(failure_);
    } catch (const Cancelled&) {
      throw;
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      if (!error.file().empty()) throw;
      throw Error(source_.name, here(), error.reason());
    }
  }
  if (status != XML_STATUS_OK)
    throw Error(source_.name, here(),
                std::string("is not well-formed XML: ") +
                    XML_ErrorString(XML_GetErrorCode(expat_->parser)));
  const XML_Index used = XML_GetCurrentByteIndex(expat_->parser);
  if (used >= 0 && fed_ - static_cast<std::uint64_t>(used) > kMaxTokenBytes)
    throw Error(source_.name, here(), "a name or a value has more than 1 MiB");
}

}  // namespace voxdag
