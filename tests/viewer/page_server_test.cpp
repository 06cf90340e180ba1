#include "viewer/server/page_server.hpp"

#include <gtest/gtest.h>

#include "gunzip.hpp"
#include "http_client.hpp"
#include "scenes.hpp"
#include "support/error_of.hpp"
#include "viewer/embedded/page_files.hpp"

namespace voxdag {
namespace {

class Server : public testing::Test {
 protected:
  Server() : server_(scene_, {}) { server_.start(); }
  int port() const { return server_.port(); }

  const PatternScene scene_{100'000};
  PageServer server_;
};

TEST_F(Server, EveryFileOfThePageHasItsTypeAndItsBytes) {
  ASSERT_FALSE(page_files().empty());
  for (const PageFile& file : page_files()) {
    const HttpAnswer answer = get(port(), std::string("/").append(file.path));
    EXPECT_EQ(answer.status, 200) << file.path;
    EXPECT_EQ(answer.fields.at("content-type"), file.type);
    EXPECT_EQ(answer.body, file.bytes);
    EXPECT_EQ(answer.fields.count("accept-ranges"), 0u);
  }
}

TEST_F(Server, ClientsThatTakeGzipGetThePageCompressed) {
  for (const char* accepted : {"gzip", "deflate, gzip;q=0.5, br", "br,gzip ; q=1"})
    for (const PageFile& file : page_files()) {
      const std::string target = std::string("/").append(file.path);
      const std::string field = std::string("Accept-Encoding: ") + accepted + "\r\n";
      const HttpAnswer answer = get(port(), target, field), plain = get(port(), target);
      EXPECT_EQ(answer.fields.at("vary"), "Accept-Encoding");
      EXPECT_EQ(plain.fields.at("vary"), "Accept-Encoding");
      EXPECT_EQ(answer.fields.at("content-type"), file.type);
      if (answer.fields.count("content-encoding") == 0) {
        EXPECT_EQ(answer.body, file.bytes) << file.path << " would be larger";
        continue;
      }
      EXPECT_EQ(answer.fields.at("content-encoding"), "gzip");
      EXPECT_LT(answer.body.size(), file.bytes.size());
      EXPECT_EQ(gunzip(answer.body), file.bytes);
      const std::string tag = answer.fields.at("etag");
      EXPECT_NE(tag, plain.fields.at("etag"));
      EXPECT_EQ(get(port(), target, field + "If-None-Match: " + tag + "\r\n").status, 304);
      EXPECT_EQ(get(port(), target, "If-None-Match: " + tag + "\r\n").status, 200);
    }
}

TEST_F(Server, ClientsThatRefuseGzipGetThePageAsItIs) {
  for (const char* accepted : {"", "identity", "gzip;q=0", "gzip; q=0.000, br", "xgzip"}) {
    const HttpAnswer answer =
        get(port(), "/", std::string("Accept-Encoding: ") + accepted + "\r\n");
    EXPECT_EQ(answer.fields.count("content-encoding"), 0u) << accepted;
    EXPECT_EQ(answer.body, find_page_file("index.html")->bytes);
  }
  EXPECT_EQ(
      get(port(), "/scene.vdag", "Accept-Encoding: gzip\r\n").fields.count("content-encoding"), 0u);
}

TEST_F(Server, TheRootIsThePage) {
  EXPECT_EQ(get(port(), "/").body, find_page_file("index.html")->bytes);
  EXPECT_EQ(get(port(), "/?eye=1,2,3").body, find_page_file("index.html")->bytes);
}

TEST_F(Server, TheSceneIsServedAsItIs) {
  const HttpAnswer answer = get(port(), "/scene.vdag");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, scene_.text(0, scene_.size() - 1));
  EXPECT_EQ(answer.fields.at("accept-ranges"), "bytes");
  EXPECT_EQ(answer.fields.at("content-type"), "application/octet-stream");
  EXPECT_EQ(answer.fields.at("etag"), "\"0123456789abcdef\"");
}

TEST_F(Server, EveryAnswerTellsBrowsersWhatThePageMayDo) {
  for (const char* target : {"/", "/scene.vdag", "/nothing"}) {
    const HttpAnswer answer = get(port(), target);
    EXPECT_TRUE(answer.fields.at("content-security-policy").starts_with("default-src 'none'; "));
    EXPECT_EQ(answer.fields.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(answer.fields.at("cross-origin-resource-policy"), "same-origin");
    EXPECT_EQ(answer.fields.at("cache-control"), "no-cache");
  }
}

TEST_F(Server, HeadHasTheFieldsOfGetAndNoBody) {
  for (const std::string target : {"/", "/scene.vdag", "/constants.js"}) {
    HttpClient client(port());
    client.send(request(target, {}, "HEAD") + request(target));
    const HttpAnswer head = client.answer(true), full = client.answer();
    EXPECT_EQ(head.status, 200);
    for (const char* field : {"content-length", "content-type", "etag"})
      EXPECT_EQ(head.fields.at(field), full.fields.at(field)) << target;
    EXPECT_TRUE(full.is_complete);
  }
}

TEST_F(Server, ARangeGivesItsBytes) {
  const struct {
    const char* range;
    std::uint64_t first, last;
  } cases[] = {{"0-0", 0, 0},
               {"0-63", 0, 63},
               {"64-", 64, 99'999},
               {"99999-", 99'999, 99'999},
               {"-1", 99'999, 99'999},
               {"-100000", 0, 99'999},
               {"-200000", 0, 99'999},
               {"70000-999999999999", 70'000, 99'999},
               {"60000-80000", 60'000, 80'000}};
  for (const auto& [range, first, last] : cases) {
    const HttpAnswer answer =
        get(port(), "/scene.vdag", std::string("Range: bytes=") + range + "\r\n");
    EXPECT_EQ(answer.status, 206) << range;
    EXPECT_EQ(answer.body, scene_.text(first, last)) << range;
    EXPECT_EQ(answer.fields.at("content-range"),
              "bytes " + std::to_string(first) + "-" + std::to_string(last) + "/100000");
  }
}

TEST_F(Server, SeveralRangesComeInParts) {
  const HttpAnswer answer =
      get(port(), "/scene.vdag", "Range: bytes=0-9, 500-509,-5, 200000-200001\r\n");
  ASSERT_EQ(answer.status, 206);
  const std::string type = answer.fields.at("content-type");
  ASSERT_TRUE(type.starts_with("multipart/byteranges; boundary="));
  const std::string boundary = "--" + type.substr(type.find('=') + 1);
  std::string expected;
  for (const auto& [first, last] : {std::pair{0, 9}, {500, 509}, {99'995, 99'999}})
    expected += (expected.empty() ? "" : "\r\n") + boundary +
                "\r\nContent-Type: application/octet-stream\r\nContent-Range: bytes " +
                std::to_string(first) + "-" + std::to_string(last) + "/100000\r\n\r\n" +
                scene_.text(static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last));
  EXPECT_EQ(answer.body, expected + "\r\n" + boundary + "--\r\n");
  // These ranges are larger than the pieces in which the server sends them.
  const HttpAnswer large = get(port(), "/scene.vdag", "Range: bytes=0-69999,70000-99998\r\n");
  EXPECT_NE(large.body.find(scene_.text(0, 69'999)), std::string::npos);
  EXPECT_NE(large.body.find(scene_.text(70'000, 99'998)), std::string::npos);
}

TEST_F(Server, WrongRangesAreRefused) {
  std::string many = "0-0";
  for (int i = 0; i < 16; ++i) many += ",0-0";
  for (const std::string& range :
       {std::string("bytes=100000-"), std::string("bytes=100000-100001"), std::string("bytes=-0"),
        std::string("bytes=-"), std::string("bytes=5-4"), std::string("bytes=x"),
        std::string("bytes="), std::string("lines=1-2"), std::string("bytes=0-99999,0-99999"),
        std::string("bytes=99999999999999999999-"), "bytes=" + many,
        "bytes=0-" + std::string(600, '1')}) {
    const HttpAnswer answer = get(port(), "/scene.vdag", "Range: " + range + "\r\n");
    EXPECT_EQ(answer.status, 416) << range;
    EXPECT_EQ(answer.body, "");
  }
  EXPECT_EQ(get(port(), "/scene.vdag", "Range: bytes=0-1\r\nRange: bytes=0-1\r\n").status, 416);
  EXPECT_EQ(get(port(), "/scene.vdag", "Range: bytes=100000-\r\n").fields.at("content-range"),
            "bytes */100000");
}

TEST_F(Server, RangesApplyToTheSceneAndToGetOnly) {
  const std::string range = "Range: bytes=0-1\r\n";
  EXPECT_EQ(get(port(), "/", range).status, 200);
  EXPECT_EQ(get(port(), "/nothing", range).status, 404);
  const HttpAnswer head = ask(port(), request("/scene.vdag", range, "HEAD"), true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.fields.at("content-length"), "100000");
}

TEST_F(Server, KnownBytesAreNotSentAgain) {
  for (const std::string target : {"/", "/scene.vdag", "/constants.js"}) {
    const std::string tag = get(port(), target).fields.at("etag");
    EXPECT_TRUE(tag.size() > 2 && tag.front() == '"' && tag.back() == '"');
    for (const std::string& known : {tag, "W/" + tag, "\"other\", " + tag, std::string("*")}) {
      const HttpAnswer answer = get(port(), target, "If-None-Match: " + known + "\r\n");
      EXPECT_EQ(answer.status, 304) << target << " " << known;
      EXPECT_EQ(answer.fields.at("etag"), tag);
      EXPECT_EQ(answer.fields.count("content-length"), 0u);
    }
    EXPECT_EQ(get(port(), target, "If-None-Match: \"other\"\r\n").status, 200);
  }
}

TEST_F(Server, ARangeOfOtherBytesBecomesTheWholeScene) {
  const std::string range = "Range: bytes=0-1\r\nIf-Range: ";
  EXPECT_EQ(get(port(), "/scene.vdag", range + "\"0123456789abcdef\"\r\n").status, 206);
  EXPECT_EQ(get(port(), "/scene.vdag", range + "\"other\"\r\n").body.size(), 100'000u);
  EXPECT_EQ(get(port(), "/scene.vdag", range + "W/\"0123456789abcdef\"\r\n").status, 200);
}

TEST_F(Server, NothingElseIsServed) {
  for (const char* target : {"/nothing",
                             "/index.htm",
                             "/INDEX.HTML",
                             "/app",
                             "/app/",
                             "/app/app.js/",
                             "//index.html",
                             "/../index.html",
                             "/..",
                             "/%2e%2e/%2e%2e/etc/passwd",
                             "/..%2f..%2fetc%2fpasswd",
                             "/../../../../etc/passwd",
                             "/app/../index.html",
                             "/app/..%5c..%5cindex.html",
                             "/scene.vdag/",
                             "/scene.vdag/../constants.js",
                             "/./index.html",
                             "/etc/passwd",
                             "/proc/self/environ",
                             "/%00",
                             "/index.html%00",
                             "/scene.vdag%00.js",
                             "/%",
                             "/%zz",
                             "/%u002e%u002e/",
                             "index.html",
                             "*",
                             "http://localhost/index.html"})
    EXPECT_EQ(get(port(), target).status, 404) << target;
}

TEST_F(Server, OnlyGetAndHeadAreAllowed) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT"}) {
    HttpClient client(port());
    client.send(request("/", "Content-Length: 5\r\n", method) + "hello" + request("/"));
    const HttpAnswer answer = client.answer();
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(answer.fields.at("allow"), "GET, HEAD");
    // The body is no second request.
    EXPECT_TRUE(client.is_closed_within(std::chrono::seconds(5))) << method;
    EXPECT_EQ(client.received, "") << method;
  }
}

TEST_F(Server, ABodyEndsTheConnection) {
  for (const char* fields :
       {"Content-Length: 30\r\n", "Transfer-Encoding: chunked\r\n", "Expect: 100-continue\r\n",
        "Content-Length: 0\r\nContent-Length: 30\r\n", "Upgrade: h2c\r\n"}) {
    HttpClient client(port());
    client.send(request("/", fields) + request("/nothing"));
    client.answer();
    EXPECT_TRUE(client.is_closed_within(std::chrono::seconds(5))) << fields;
    EXPECT_EQ(client.received.find("HTTP/1.1 404"), std::string::npos) << fields;
  }
}

TEST_F(Server, MalformedRequestsAreRefused) {
  for (const std::string& text :
       {std::string("\r\n\r\n"), std::string("GET\r\n\r\n"), std::string("GET /\r\n\r\n"),
        std::string("GET / HTTP/2.0\r\n\r\n"), std::string("FOO / HTTP/1.1\r\n\r\n"),
        std::string("GET / / HTTP/1.1\r\n\r\n"), std::string("GET / HTTP/1.1\r\nno colon\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\n: x\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost : localhost\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost: localhost\r\n continued: x\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: a\nb\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nX: a\rb\r\n\r\n"),
        std::string("GET /\0 HTTP/1.1\r\n\r\n", 19), std::string("\x16\x03\x01\x02\r\n\r\n")}) {
    EXPECT_EQ(ask(port(), text).status, 400) << text;
  }
  EXPECT_EQ(get(port(), "/").status, 200);
}

TEST_F(Server, OtherHostNamesAreRefused) {
  const auto status = [this](const std::string& fields) {
    return ask(port(), "GET /scene.vdag HTTP/1.1\r\n" + fields + "\r\n").status;
  };
  for (const char* host : {"localhost", "localhost:1234", "127.0.0.1", "127.0.0.1:80", "[::1]:80"})
    EXPECT_EQ(status("Host: " + std::string(host) + "\r\n"), 200) << host;
  for (const char* host : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "",
                           "evil.example:80", "localhost@evil.example", "10.0.0.1", "[::2]"})
    EXPECT_EQ(status("Host: " + std::string(host) + "\r\n"), 403) << host;
  EXPECT_EQ(status(""), 403);
  EXPECT_EQ(status("Host: evil.example\r\nRange: bytes=0-1\r\n"), 403);
}

TEST_F(Server, AConnectionServesManyRequests) {
  HttpClient client(port());
  for (int i = 0; i < 50; ++i) {
    client.send(request("/scene.vdag", "Range: bytes=" + std::to_string(i) + "-100\r\n"));
    EXPECT_EQ(client.answer().body.size(), static_cast<std::size_t>(101 - i));
  }
  client.send(request("/", "Connection: close\r\n"));
  EXPECT_EQ(client.answer().status, 200);
  EXPECT_TRUE(client.is_closed_within(std::chrono::seconds(5)));
}

TEST(ServerAddress, APortInUseIsAnError) {
  const PatternScene scene(100);
  const PageServer first(scene, {});
  const std::string error = error_of([&] { PageServer second(scene, {.port = first.port()}); });
  EXPECT_NE(error.find("cannot listen on 127.0.0.1, port"), std::string::npos);
  EXPECT_NE(error.find("in use"), std::string::npos) << error;
}

TEST(ServerAddress, AnUnknownAddressIsAnError) {
  const PatternScene scene(100);
  for (const char* address : {"192.0.2.1", "no-such-host.invalid"})
    EXPECT_NE(error_of([&] {
                PageServer server(scene, {.address = address});
              }).find(std::string("cannot listen on ") + address),
              std::string::npos);
}

TEST(ServerAddress, TheUrlLeadsToThePage) {
  const PatternScene scene(100);
  const PageServer server(scene, {});
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/");
}

TEST(ServerAddress, OnAllAddressesAnyHostNameIsServed) {
  const PatternScene scene(100);
  PageServer server(scene, {.address = "0.0.0.0"});
  server.start();
  EXPECT_EQ(ask(server.port(), "GET / HTTP/1.1\r\nHost: machine.example\r\n\r\n").status, 200);
}

}  // namespace
}  // namespace voxdag
