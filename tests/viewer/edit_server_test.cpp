#include <gtest/gtest.h>

#include "edit_page.hpp"
#include "scenes.hpp"
#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "viewer/server/page_server.hpp"

namespace voxdag {
namespace {

using namespace std::chrono_literals;

constexpr int kLevels = 4;
constexpr char kRemoveAll[] = "remove,box,0,0,0,16,16,16";

ServerOptions options_of(EditSession& session) {
  ServerOptions options;
  options.editing = &session;
  options.limits.body = 300ms;
  return options;
}

class EditServer : public testing::Test {
 protected:
  EditServer()
      : base_(brute_svdag(kLevels, random_voxels(kLevels, 500, 3))),
        mirror_(base_.view()),
        session_({base_.view(), {}}, {kLevels, {}, 1, kSubvoxels}, "/nowhere/a.vdag",
                 [](const EditSnapshot&, const std::filesystem::path&) {}),
        server_(scene_, options_of(session_)) {
    server_.start();
    const std::string url = server_.url();
    token_ = url.substr(url.find('=') + 1);
    const HttpAnswer answer = ask(port(), edit_request(port(), "open", token_, 0));
    EXPECT_EQ(answer.status, 200);
    mirror_.take(answer.body);
  }
  int port() const { return server_.port(); }
  std::string stroke(const std::string& lines = kRemoveAll) const {
    return edit_request(port(), "stroke", token_, mirror_.writer, lines);
  }
  /// Returns a request in which `part` is replaced by `by`.
  std::string with(const std::string& part, const std::string& by) const {
    std::string text = stroke();
    text.replace(text.find(part), part.size(), by);
    return text;
  }
  /// Returns whether nobody has edited the scene.
  bool is_untouched() {
    return ask(port(), edit_request(port(), "undo", token_, mirror_.writer)).body.size() == 40 &&
           mirror_of_now().undos == 0;
  }
  EditMirror mirror_of_now() {
    mirror_.take(ask(port(), edit_request(port(), "open", token_, 0)).body);
    return mirror_;
  }

  const PatternScene scene_{1000};
  const Svdag base_;
  EditMirror mirror_;
  EditSession session_;
  PageServer server_;
  std::string token_;
};

TEST_F(EditServer, ThePageOfTheAddressEdits) {
  const HttpAnswer answer = ask(port(), stroke("remove,ball,8,8,8,4"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.fields.at("content-type"), "application/octet-stream");
  mirror_.take(answer.body);
  EXPECT_NE(mirror_.dag(), base_);
  mirror_.take(ask(port(), edit_request(port(), "undo", token_, mirror_.writer)).body);
  EXPECT_EQ(mirror_.dag(), base_);
  EXPECT_EQ(ask(port(), edit_request(port(), "file", token_, 0)).body, "a.vdag\n");
}

TEST_F(EditServer, NobodyElseOnThisMachineEdits) {
  const std::string token = "Voxdag-Token: " + token_;
  for (const std::string& by :
       {std::string("X: y"), std::string("Voxdag-Token: "), std::string("Voxdag-Token: 0"),
        "Voxdag-Token: " + token_ + "0", "Voxdag-Token: " + token_.substr(0, 31),
        "Voxdag-Token: " + std::string(32, '0'), "Cookie: edit=" + token_})
    EXPECT_EQ(ask(port(), with(token, by)).status, 403) << by;
  EXPECT_EQ(get(port(), "/?edit=" + token_).status, 200);
  EXPECT_EQ(get(port(), "/").body.find(token_), std::string::npos);
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, NoForeignPageEdits) {
  const std::string host = "127.0.0.1:" + std::to_string(port()), origin = "Origin: http://" + host;
  for (const std::string& by :
       {std::string("X: y"), std::string("Origin: null"),
        std::string("Origin: http://evil.example"), std::string("Origin: http://127.0.0.1"),
        std::string("Origin: http://127.0.0.1:1"),
        std::string("Origin: http://localhost:") + std::to_string(port()),
        "Origin: https://" + host, origin + "\r\n" + origin, origin + ".evil.example"})
    EXPECT_EQ(ask(port(), with(origin, by)).status, 403) << by;
  // A name of another site for this address.
  std::string rebound = with("Host: " + host, "Host: evil.example");
  EXPECT_EQ(ask(port(), rebound).status, 403);
  rebound.replace(rebound.find(origin), origin.size(), "Origin: http://evil.example");
  EXPECT_EQ(ask(port(), rebound).status, 403);
  // A page asks with OPTIONS whether it may send the fields of another origin.
  EXPECT_EQ(ask(port(), with("POST", "OPTIONS")).status, 405);
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, OtherMethodsAndPathsDoNothing) {
  for (const char* method : {"GET", "HEAD"})
    EXPECT_EQ(ask(port(), with("POST", method), std::string(method) == "HEAD").status, 404);
  for (const char* method : {"PUT", "DELETE", "PATCH"})
    EXPECT_EQ(ask(port(), with("POST", method)).status, 405);
  for (const char* path : {"/edit/", "/edit/all", "/edit/../edit/stroke", "/edit/stroke/"})
    EXPECT_EQ(ask(port(), with("/edit/stroke", path)).status, 404) << path;
  EXPECT_EQ(ask(port(), with("/edit/stroke", "/")).status, 405);
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, GarbageIsRefusedWithALine) {
  for (const std::string& body :
       {std::string("dig"), std::string("\0\0", 2), std::string(60000, ','),
        std::string("remove,ball,1e999,0,0,1"), std::string("{}")}) {
    const HttpAnswer answer = ask(port(), stroke(body));
    EXPECT_EQ(answer.status, 400);
    EXPECT_TRUE(answer.body.starts_with("line 1: ")) << answer.body;
    EXPECT_EQ(answer.body.find('\n'), answer.body.size() - 1);
  }
  EXPECT_EQ(
      ask(port(), edit_request(port(), "stroke", token_, mirror_.writer + 1, kRemoveAll)).status,
      409);
  EXPECT_EQ(ask(port(), with("Voxdag-Writer: ", "Voxdag-Writer: x")).status, 409);
  EXPECT_EQ(ask(port(), edit_request(port(), "save", token_, mirror_.writer, "../a")).status, 400);
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, ABodyMustBeSmallAndOfAKnownLength) {
  const std::string length = "Content-Length: " + std::to_string(sizeof kRemoveAll - 1);
  const struct {
    std::string by;
    int status;
  } cases[] = {{"Content-Length: 65537", 413},
               {"Content-Length: 99999999999999999999999", 413},
               {"Content-Length: -1", 400},
               {"Content-Length: 1x", 400},
               {"Content-Length: ", 400}};
  for (const auto& [by, status] : cases) {
    HttpClient client(port());
    client.send(with(length, by));
    EXPECT_EQ(client.answer().status, status) << by;
    EXPECT_TRUE(client.is_closed_within(5s)) << by;
  }
  for (const std::string& by :
       {std::string("Transfer-Encoding: chunked"), length + "\r\n" + length,
        length + "\r\nExpect: 100-continue", length + "\r\nTransfer-Encoding: chunked"}) {
    HttpClient client(port());
    client.send(with(length, by));
    client.answer();
    EXPECT_TRUE(client.is_closed_within(5s)) << by;
  }
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, ASlowBodyEndsTheConnection) {
  HttpClient client(port());
  const std::string text = stroke();
  client.send(text.substr(0, text.size() - 5));
  EXPECT_EQ(client.answer().status, 408);
  EXPECT_TRUE(client.is_closed_within(5s));
  EXPECT_TRUE(is_untouched());
}

TEST_F(EditServer, RequestsWithBodiesFollowEachOther) {
  HttpClient client(port());
  client.send(stroke("remove,ball,4,4,4,2") + stroke("remove,ball,9,9,9,2") + request("/"));
  for (const std::uint32_t undos : {1u, 2u}) {
    mirror_.take(client.answer().body);
    EXPECT_EQ(mirror_.undos, undos);
  }
  EXPECT_EQ(client.answer().status, 200);
}

TEST_F(EditServer, OtherMachinesCannotEdit) {
  ServerOptions options = options_of(session_);
  options.address = "0.0.0.0";
  EXPECT_TRUE(error_of([&] {
                PageServer server(scene_, options);
              }).starts_with("cannot edit on 0.0.0.0: "));
}

TEST_F(EditServer, EachServerHasItsOwnSecret) {
  const PageServer other(scene_, options_of(session_));
  EXPECT_EQ(token_.size(), 32u);
  EXPECT_NE(other.url().substr(other.url().find('=') + 1), token_);
}

}  // namespace
}  // namespace voxdag
