/// Tests the server with slow clients, hostile clients and many clients.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "http_client.hpp"
#include "scenes.hpp"
#include "viewer/server/page_server.hpp"

namespace voxdag {
namespace {

using namespace std::chrono_literals;

/// Larger than all buffers between the server and a client.
constexpr std::uint64_t kHuge = std::uint64_t{1} << 30;

ServerOptions with_limits(const ServerLimits& limits) {
  ServerOptions options;
  options.limits = limits;
  return options;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(ServerLoad, AHundredClientsAtOnce) {
  const PatternScene scene(300'000);
  PageServer server(scene, {});
  server.start();
  std::atomic<int> right = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 100; ++i)
    clients.emplace_back([&, i] {
      HttpClient client(server.port());
      for (int k = 0; k < 5; ++k) {
        const auto first = static_cast<std::uint64_t>(1000 * i + k);
        client.send(request("/scene.vdag", "Range: bytes=" + std::to_string(first) + "-" +
                                               std::to_string(first + 9999) + "\r\n"));
        right += client.answer().body == scene.text(first, first + 9999) ? 1 : 0;
      }
    });
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(right, 500);
}

TEST(ServerLoad, ASlowClientDelaysNoOther) {
  const PatternScene scene(1000);
  PageServer server(scene, {});
  server.start();
  std::vector<std::unique_ptr<HttpClient>> slow;
  for (int i = 0; i < 100; ++i) {
    slow.push_back(std::make_unique<HttpClient>(server.port()));
    slow.back()->send("GET / HT");
  }
  EXPECT_EQ(get(server.port(), "/").status, 200);
  slow[50]->send("TP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(slow[50]->answer().status, 200);
}

TEST(ServerLoad, ARequestByteByByteIsEnded) {
  const PatternScene scene(1000);
  PageServer server(scene, with_limits({.head = 400ms}));
  server.start();
  HttpClient client(server.port());
  const auto start = std::chrono::steady_clock::now();
  const std::string text = request("/", "X: " + std::string(1000, 'x') + "\r\n");
  for (std::size_t i = 0; i < text.size() && client.received.empty(); ++i)
    if (!client.send(text.substr(i, 1)) || client.fill(1, 20ms)) break;
  EXPECT_EQ(client.answer().status, 408);
  EXPECT_TRUE(client.is_closed_within(5s));
  EXPECT_GE(seconds_since(start), 0.4);
}

TEST(ServerLoad, AnIdleConnectionIsEnded) {
  const PatternScene scene(1000);
  PageServer server(scene, with_limits({.idle = 300ms}));
  server.start();
  HttpClient client(server.port());
  EXPECT_TRUE(client.is_closed_within(10s));
  EXPECT_EQ(client.received, "");
}

TEST(ServerLoad, IdleConnectionsMakeWay) {
  const PatternScene scene(1000);
  PageServer server(scene, with_limits({.most_connections = 4}));
  server.start();
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 40; ++i) {
    idle.push_back(std::make_unique<HttpClient>(server.port()));
    idle.back()->send(request("/"));
    EXPECT_EQ(idle.back()->answer().status, 200) << i;
  }
  EXPECT_TRUE(idle[0]->is_closed_within(5s));
}

TEST(ServerLoad, BusyConnectionsDoNotMakeWay) {
  const PatternScene scene(kHuge);
  PageServer server(scene, with_limits({.most_connections = 4}));
  server.start();
  std::vector<std::unique_ptr<HttpClient>> busy;
  for (int i = 0; i < 4; ++i) {
    busy.push_back(std::make_unique<HttpClient>(server.port(), 4096));
    busy.back()->send(request("/scene.vdag"));
    EXPECT_TRUE(busy.back()->fill(1000));
  }
  EXPECT_EQ(get(server.port(), "/").status, 503);
  busy.pop_back();
  int status = 0;
  for (int i = 0; i < 100 && status != 200; ++i) {
    std::this_thread::sleep_for(50ms);
    status = get(server.port(), "/").status;
  }
  EXPECT_EQ(status, 200);
}

TEST(ServerLoad, AClientThatDoesNotReadIsEnded) {
  const PatternScene scene(kHuge);
  PageServer server(scene, with_limits({.stall = 300ms}));
  server.start();
  HttpClient client(server.port(), 4096);
  client.send(request("/scene.vdag"));
  std::this_thread::sleep_for(1s);
  const HttpAnswer answer = client.answer();
  EXPECT_EQ(answer.status, 200);
  EXPECT_FALSE(answer.is_complete);
}

TEST(ServerLoad, AClientThatReadsTooSlowlyIsEnded) {
  const PatternScene scene(kHuge);
  PageServer server(scene, with_limits({.grace = 300ms, .least_rate = 1e12}));
  server.start();
  HttpClient client(server.port());
  client.send(request("/scene.vdag"));
  EXPECT_FALSE(client.answer().is_complete);
}

TEST(ServerLoad, AClientThatLeavesHarmsNobody) {
  const PatternScene scene(kHuge);
  PageServer server(scene, {});
  server.start();
  for (int i = 0; i < 200; ++i) {
    HttpClient client(server.port());
    client.send(i % 3 == 0 ? "GET /sce" : request("/scene.vdag"));
    if (i % 3 == 1) client.fill(10);
  }
  EXPECT_EQ(get(server.port(), "/").status, 200);
}

TEST(ServerLoad, TooMuchHeadIsRefused) {
  const PatternScene scene(1000);
  PageServer server(scene, {});
  server.start();
  std::string fields;
  for (int i = 0; i < 101; ++i) fields += "X: y\r\n";
  EXPECT_EQ(get(server.port(), "/", fields).status, 431);
  // A line without an end, a long target, a long field.
  EXPECT_EQ(ask(server.port(), std::string(16384, 'x')).status, 431);
  EXPECT_EQ(get(server.port(), std::string("/").append(20'000, 'x')).status, 431);
  EXPECT_EQ(get(server.port(), "/", "X: " + std::string(20'000, 'x') + "\r\n").status, 431);
  EXPECT_EQ(get(server.port(), std::string("/").append(9000, 'x')).status, 414);
  EXPECT_EQ(get(server.port(), "/").status, 200);
}

TEST(ServerLoad, DamagedRequestsHarmNothing) {
  const PatternScene scene(1000);
  PageServer server(scene, with_limits({.head = 200ms, .idle = 200ms}));
  server.start();
  const std::string whole =
      request("/scene.vdag",
              "Range: bytes=0-9,20-29, -5\r\nIf-Range: \"a\"\r\nIf-None-Match: "
              "W/\"a\", *\r\nAccept: */*\r\nConnection: keep-alive\r\n");
  std::mt19937 random(21);
  for (int i = 0; i < 1000; ++i) {
    std::string text = whole;
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, random() % 20);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 40));
          break;
        default:
          text.insert(at, std::string(random() % 3000, static_cast<char>(random())));
      }
    }
    HttpClient client(server.port());
    client.send(text);
    if (i % 4 == 0) client.fill(1, 50ms);
  }
  EXPECT_EQ(get(server.port(), "/scene.vdag", "Range: bytes=1-2\r\n").body, scene.text(1, 2));
}

TEST(ServerLoad, PipelinedRequestsAreAnsweredInOrder) {
  const PatternScene scene(1000);
  PageServer server(scene, {});
  server.start();
  HttpClient client(server.port());
  std::string requests;
  for (int i = 0; i < 20; ++i)
    requests += request("/scene.vdag", "Range: bytes=" + std::to_string(i) + "-29\r\n");
  client.send(requests);
  for (std::uint64_t i = 0; i < 20; ++i) EXPECT_EQ(client.answer().body, scene.text(i, 29));
}

TEST(ServerLoad, StopEndsOpenConnectionsAtOnce) {
  const PatternScene scene(kHuge);
  PageServer server(scene, {});
  server.start();
  std::vector<std::unique_ptr<HttpClient>> clients;
  for (int i = 0; i < 30; ++i) {
    clients.push_back(std::make_unique<HttpClient>(server.port(), 4096));
    if (i % 3 != 0) clients.back()->send(i % 3 == 1 ? request("/scene.vdag") : "GET /");
  }
  EXPECT_TRUE(clients[1]->fill(1000));
  const auto start = std::chrono::steady_clock::now();
  server.stop();
  // The limits are tens of seconds.
  EXPECT_LT(seconds_since(start), 5);
  for (const auto& client : clients) EXPECT_TRUE(client->is_closed_within(10s));
}

}  // namespace
}  // namespace voxdag
