#pragma once
/// One page and one stream of messages to every browser that has it open (libwebsockets).

#include <libwebsockets.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim_host/telemetry/web_access.hpp"

namespace s4tp::telemetry {

class WebServer {
 public:
  /// \param port  0: one that is free
  /// \param kept  so many of the newest messages are kept for who comes later
  /// \throws std::runtime_error when the address cannot be listened on
  WebServer(const std::string& address, int port, std::string page, std::size_t kept);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  /// Pages that are open.
  [[nodiscard]] int readers() const { return readers_; }

  /// VIEW-022 Every page gets every message in its order, those kept first; one that reads too slowly goes on
  /// with the oldest that is kept.
  void publish(std::string message);
  /// VIEW-023 Of these only the newest counts; every page gets it, who comes later before all messages.
  void set_state(std::string state);

  /// Serves, and calls `work` every `period_us`, until it returns false.
  void run(std::uint64_t period_us, const std::function<bool()>& work);

 private:
  /// One open page.
  struct Reader {
    std::uint64_t next;           ///< number of the message to send
    std::uint64_t state_version;  ///< last one sent
    bool counted;
  };
  /// A timer with its way back to us.
  struct Timer {
    lws_sorted_usec_list_t entry;
    WebServer* server;
  };

  static int on_http(lws* connection, lws_callback_reasons reason, void* user, void* in, std::size_t length);
  static int on_socket(lws* connection, lws_callback_reasons reason, void* user, void* in,
                       std::size_t length);
  static void on_timer(lws_sorted_usec_list_t* entry);
  [[nodiscard]] bool welcome(lws* connection) const;
  int send_page(lws* connection, const std::string& path);
  int send_next(lws* connection, Reader& reader);
  int write(lws* connection, const std::string& text);

  lws_protocols protocols_[3] = {};
  lws_context* context_ = nullptr;
  lws_vhost* host_ = nullptr;
  int port_ = 0;
  std::unique_ptr<WebAccess> access_;
  std::string page_;
  std::size_t kept_;
  std::deque<std::string> messages_;
  std::uint64_t first_ = 1;  ///< number of the oldest message kept
  std::string state_;
  std::uint64_t state_version_ = 0;
  int readers_ = 0;
  std::vector<unsigned char> room_;  ///< of what is being sent
  Timer timer_ = {};
  std::uint64_t period_us_ = 0;
  std::function<bool()> work_;
  bool goes_on_ = true;
};

}  // namespace s4tp::telemetry
