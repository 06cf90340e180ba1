#include "viewer/server/edit_answers.hpp"

#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <system_error>

namespace voxdag {
namespace {

void give_text(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

/// Returns whether both texts are equal, in a time that does not tell how much of them is.
bool are_equal(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differ |= static_cast<unsigned>(a[i] ^ b[i]);
  return differ == 0;
}

/// Returns the number that the field has; 0, which is no page's, if it has none.
std::uint32_t writer_of(const httplib::Request& request) {
  const std::string text = request.get_header_value("Voxdag-Writer");
  const char* const end = text.data() + text.size();
  std::uint32_t writer = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, writer);
  return error == std::errc() && stop == end ? writer : 0;
}

}  // namespace

std::string make_token() {
  std::uint8_t bytes[16];
  if (getentropy(bytes, sizeof bytes) != 0)
    throw Error("the system gives no random numbers: " + std::system_category().message(errno));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string token;
  for (const std::uint8_t byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

bool EditAnswers::is_allowed(const httplib::Request& request) const {
  return request.get_header_value_count("Origin") == 1 &&
         request.get_header_value("Origin") == "http://" + request.get_header_value("Host") &&
         are_equal(request.get_header_value("Voxdag-Token"), token_);
}

void EditAnswers::answer(const httplib::Request& request, httplib::Response& response) const {
  if (!is_allowed(request))
    return give_text(response, 403, "only the page of the address that voxdag printed may edit");
  try {
    if (!answer_edit(request, response)) give_text(response, 404, "not found");
  } catch (const NotTheWriter& error) {
    give_text(response, 409, error.what());
  } catch (const FileExists& error) {
    give_text(response, 412, error.what());
  } catch (const Error& error) {
    give_text(response, 400, error.what());
  } catch (const std::bad_alloc&) {
    give_text(response, 400, "there is not enough memory");
  }
}

bool EditAnswers::answer_edit(const httplib::Request& request, httplib::Response& response) const {
  const std::uint32_t writer = writer_of(request);
  const auto give = [&](std::string update) {
    response.set_content(std::move(update), "application/octet-stream");
    return true;
  };
  if (request.path == "/edit/open") return give(session_.open());
  if (request.path == "/edit/stroke")
    return give(session_.stroke(writer, request.body, request.has_param("more")));
  if (request.path == "/edit/undo") return give(session_.undo(writer));
  if (request.path == "/edit/redo") return give(session_.redo(writer));
  if (request.path == "/edit/file") return give_text(response, 200, session_.file_name()), true;
  if (request.path != "/edit/save") return false;
  const auto path = save_path({}, request.body);
  session_.save(writer, request.body, request.has_param("replace"));
  give_text(response, 200, path.string());
  return true;
}

}  // namespace voxdag
