#include "studies/live/server.h"

#include <civetweb.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/coarse_press.h"

using namespace fingertip;
using namespace fingertip::studies;
using namespace std::chrono_literals;

namespace {

/// A page without a browser: CivetWeb's own client.
class Page {
 public:
  Page(int port, const std::string& token, const std::string& origin) {
    char error[256] = "";
    connection_ = mg_connect_websocket_client("127.0.0.1", port, 0, error, sizeof error,
                                              ("/stream?token=" + token).c_str(), origin.c_str(),
                                              &Page::on_data, &Page::on_close, this);
  }
  ~Page() {
    if (connection_ != nullptr) mg_close_connection(connection_);
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  bool connected() const { return connection_ != nullptr; }
  bool closed() const { return closed_; }
  void send(const std::string& text, int opcode = MG_WEBSOCKET_OPCODE_TEXT) {
    mg_websocket_client_write(connection_, opcode, text.data(), text.size());
  }
  /// Whether the condition on the last frame (null before one came) becomes true.
  template <class Condition>
  bool wait_for(Condition condition, std::chrono::milliseconds patience = 10s) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [&] { return condition(*this); });
  }
  std::atomic<bool> acknowledges = true;

  // Read within wait_for's condition, or when nothing comes any more.
  nlohmann::json scene, frame;
  int frames = 0, errors = 0;
  std::string last_error;

 private:
  static int on_data(mg_connection*, int bits, char* data, std::size_t size, void* self) {
    static_cast<Page*>(self)->take(bits & 0x0f, {data, size});
    return 1;
  }
  static void on_close(const mg_connection*, void* self) {
    auto* us = static_cast<Page*>(self);
    us->closed_ = true;
    us->changed_.notify_all();
  }
  void take(int opcode, std::string_view data) {
    std::uint64_t number = 0;
    {
      const std::lock_guard lock(mutex_);
      if (opcode == MG_WEBSOCKET_OPCODE_TEXT) {
        const auto message = nlohmann::json::parse(data);
        if (message.at("type") == "scene") scene = message;
        if (message.at("type") == "error") {
          ++errors;
          last_error = message.at("message");
        }
      } else if (opcode == MG_WEBSOCKET_OPCODE_BINARY) {
        std::uint32_t length = 0;
        std::memcpy(&length, data.data(), 4);
        frame = nlohmann::json::parse(data.substr(4, length));
        ++frames;
        number = frame.at("number");
      }
    }
    changed_.notify_all();
    if (number > 0 && acknowledges) send(fmt::format(R"({{"type":"ack","frame":{}}})", number));
  }

  mg_connection* connection_ = nullptr;
  std::atomic<bool> closed_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

class LiveServerTest : public testing::Test {
 protected:
  void SetUp() override {
    simulation_ = std::make_unique<Simulation>(coarse_press(), PaceSettings{true, 0.0, {}}, [this] {
      if (LiveServer* server = listener_) server->frame_ready();
    });
    server_ = std::make_unique<LiveServer>(*simulation_, reference_, 0);
    listener_ = server_.get();
  }
  void TearDown() override {
    simulation_->stop();
    listener_ = nullptr;
  }
  std::unique_ptr<Page> page() { return page(server_->token(), origin()); }
  std::unique_ptr<Page> page(const std::string& token, const std::string& from) {
    return std::make_unique<Page>(server_->port(), token, from);
  }
  std::string origin() const { return fmt::format("http://127.0.0.1:{}", server_->port()); }

  /// The status of a plain request with these further header lines.
  int status_of(const std::string& path, const std::string& headers, std::string* whole = nullptr) {
    const std::string answer = exchange("GET " + path + " HTTP/1.1\r\n" + headers + "\r\n");
    if (whole != nullptr) *whole = answer;
    return answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0;
  }
  int raw_socket() const {
    const int socket_number = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(server_->port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{5, 0};
    ::setsockopt(socket_number, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_EQ(::connect(socket_number, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    return socket_number;
  }
  static void put(int socket_number, const std::string& bytes) {
    ::send(socket_number, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  std::string exchange(const std::string& request) const {
    const int socket_number = raw_socket();
    put(socket_number, request);
    std::string answer;
    char buffer[4096];
    for (ssize_t n = 1; n > 0;) {
      n = ::recv(socket_number, buffer, sizeof buffer, 0);
      if (n > 0) answer.append(buffer, std::size_t(n));
    }
    ::close(socket_number);
    return answer;
  }
  std::string here() const { return fmt::format("Host: 127.0.0.1:{}\r\n", server_->port()); }
  std::string handshake() const {
    return "GET /stream?token=" + server_->token() + " HTTP/1.1\r\n" + here() +
           "Origin: " + origin() +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  }

  Reference reference_;
  std::atomic<LiveServer*> listener_ = nullptr;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<LiveServer> server_;
};

const auto has_frame = [](const Page& page) { return page.frames > 0; };

}  // namespace

TEST_F(LiveServerTest, ServesThePageToThoseWhoKnowTheToken) {
  const std::string query = "?token=" + server_->token();
  std::string answer;
  EXPECT_EQ(status_of("/" + query, here(), &answer), 200);
  EXPECT_NE(answer.find("<!doctype html>"), std::string::npos);
  EXPECT_NE(answer.find("Content-Security-Policy"), std::string::npos);
  const std::string cookie =
      fmt::format("Cookie: fingertip_{}={}\r\n", server_->port(), server_->token());
  for (const char* path : {"/", "/page.js", "/page.css", "/three.min.js", "/OrbitControls.js"})
    EXPECT_EQ(status_of(path, here() + cookie), 200) << path;
  EXPECT_EQ(status_of("/", here()), 403);
  EXPECT_EQ(status_of("/?token=guess", here()), 403);
  EXPECT_EQ(status_of("/" + query, "Host: evil.example\r\n"), 403);
  EXPECT_EQ(status_of("/" + query, here() + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(status_of("/../server.cc" + query, here()), 404);
  EXPECT_EQ(status_of("/nothing" + query, here()), 404);
}

TEST_F(LiveServerTest, RefusesForeignOriginsAndWrongTokens) {
  EXPECT_TRUE(page()->connected());
  EXPECT_FALSE(page("guess", origin())->connected());
  EXPECT_FALSE(page("", origin())->connected());
  EXPECT_FALSE(page(server_->token(), "http://evil.example")->connected());
  EXPECT_FALSE(page(server_->token(), "null")->connected());
  EXPECT_FALSE(
      page(server_->token(), fmt::format("https://127.0.0.1:{}", server_->port()))->connected());
}

TEST_F(LiveServerTest, StepsRunsResetsAndClampsSettings) {
  const auto page = this->page();
  ASSERT_TRUE(page->wait_for(has_frame));
  EXPECT_EQ(page->scene.at("title"), "hookean lattice, R/5, stick contact");
  EXPECT_EQ(page->scene.at("masses"), page->frame.at("masses"));
  page->send(R"({"type":"step"})");
  EXPECT_TRUE(page->wait_for(
      [](const Page& p) { return std::abs(p.frame.at("time").get<double>() - 1e-3) < 1e-9; }));
  page->send(R"({"type":"set","name":"depth","value":99})");
  EXPECT_TRUE(page->wait_for([](const Page& p) {
    return p.frame.at("settings").at("depth") == p.scene.at("limits").at("depth")[1];
  }));
  page->send(R"({"type":"run"})");
  EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("normal_force") > 0.02; }, 30s));
  page->send(R"({"type":"pause"})");
  EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("status") == "paused"; }));
  page->send(R"({"type":"reset"})");
  EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("time") == 0.0; }));
}

TEST_F(LiveServerTest, MalformedMessagesAreAnsweredAndIgnored) {
  const auto page = this->page();
  ASSERT_TRUE(page->wait_for(has_frame));
  int sent = 0;
  for (const char* text : {"", "nonsense", "{\"type\":\"fly\"}", "\xff\xff", "[[[[[["}) {
    page->send(text);
    ++sent;
    EXPECT_TRUE(page->wait_for([sent](const Page& p) { return p.errors == sent; })) << text;
  }
  page->send(R"({"type":"step"})");  // and still works
  EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("time") > 0.0; }));
}

TEST_F(LiveServerTest, OversizedBinaryAndTooManyMessagesEndTheConnection) {
  const auto ended = [](const Page& page) { return page.closed(); };
  const auto large = page(), binary = page(), eager = page();
  large->send(std::string(100000, 'x'));
  EXPECT_TRUE(large->wait_for(ended));
  binary->send("abc", MG_WEBSOCKET_OPCODE_BINARY);
  EXPECT_TRUE(binary->wait_for(ended));
  for (int i = 0; i < 2000 && !eager->closed(); ++i) eager->send(R"({"type":"pause"})");
  EXPECT_TRUE(eager->wait_for(ended));
  EXPECT_TRUE(page()->wait_for(has_frame));
}

TEST_F(LiveServerTest, AHundredClientsDoNotBreakIt) {
  std::vector<std::unique_ptr<Page>> pages;
  for (int i = 0; i < 100; ++i) pages.push_back(page());
  std::vector<Page*> served;  // on a busy machine not the first ones
  for (const auto& page : pages)
    if (page->connected() && !page->closed() && page->wait_for(has_frame, 2000ms))
      served.push_back(page.get());
  ASSERT_EQ(int(served.size()), max_clients);
  EXPECT_EQ(server_->clients(), max_clients);
  served.front()->send(R"({"type":"run"})");
  for (Page* page : {served.front(), served[10], served.back()})
    EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("time") > 0.005; }));
  pages.clear();
  for (int tries = 0; tries < 100 && server_->clients() > 0; ++tries)
    std::this_thread::sleep_for(50ms);
  EXPECT_EQ(server_->clients(), 0);
  EXPECT_TRUE(page()->wait_for(has_frame));
}

TEST_F(LiveServerTest, SilentClientsGetOneFrameAndHoldUpNobody) {
  const auto silent = page(), other = page();
  silent->acknowledges = false;
  other->send(R"({"type":"run"})");
  EXPECT_TRUE(other->wait_for([](const Page& p) { return p.frames > 10; }));
  EXPECT_LE(silent->frames, 2);  // the first may have come before it fell silent
}

TEST_F(LiveServerTest, CloseAndReopenContinues) {
  double before = 0.0;
  {
    const auto first = page();
    first->send(R"({"type":"run"})");
    ASSERT_TRUE(first->wait_for([](const Page& p) { return p.frames > 3; }));
    before = first->frame.at("time");
  }
  std::this_thread::sleep_for(200ms);
  const auto second = page();
  EXPECT_TRUE(second->wait_for([&](const Page& p) {
    return p.frames > 0 && p.frame.at("time") > before && p.frame.at("epoch") == 0;
  }));
  EXPECT_EQ(second->frame.at("status"), "running");
}

TEST_F(LiveServerTest, ConnectionsThatBreakInTheMiddleLeaveNothingBehind) {
  for (int i = 0; i < 20; ++i) {
    const int socket_number = raw_socket();
    put(socket_number, handshake());
    char buffer[64];
    EXPECT_GT(::recv(socket_number, buffer, sizeof buffer, 0), 0);
    // A text of 100 bytes is announced, and 10 come.
    put(socket_number, std::string("\x81\xe4\x01\x02\x03\x04", 6) + std::string(10, 'x'));
    ::close(socket_number);
  }
  for (int i = 0; i < 5; ++i) {
    const int socket_number = raw_socket();
    put(socket_number, handshake().substr(0, 40));
    ::close(socket_number);
  }
  for (int tries = 0; tries < 100 && server_->clients() > 0; ++tries)
    std::this_thread::sleep_for(50ms);
  EXPECT_EQ(server_->clients(), 0);
  EXPECT_TRUE(page()->wait_for(has_frame));
}

TEST_F(LiveServerTest, RandomBytesDoNotBreakIt) {
  std::mt19937 random(6);
  for (int i = 0; i < 60; ++i) {
    const int socket_number = raw_socket();
    std::string bytes = i % 3 == 0 ? "" : handshake();
    if (i % 3 == 1) bytes[random() % bytes.size()] = char(random());
    const std::size_t count = random() % 3000;
    for (std::size_t k = 0; k < count; ++k) bytes.push_back(char(random()));
    put(socket_number, bytes);
    ::close(socket_number);
  }
  const auto page = this->page();
  EXPECT_TRUE(page->wait_for(has_frame));
  page->send(R"({"type":"step"})");
  EXPECT_TRUE(page->wait_for([](const Page& p) { return p.frame.at("time") > 0.0; }));
}

TEST_F(LiveServerTest, ATakenPortIsRefused) {
  EXPECT_THROW(LiveServer(*simulation_, reference_, server_->port()), meshes::InvalidInput);
}
