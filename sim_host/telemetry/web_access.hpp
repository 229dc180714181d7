#pragma once
/// Whom the view's server answers. A page of a stranger can make the browser of somebody who sits here send
/// requests to us, and a name of the stranger's that leads here (DNS rebinding) makes them look like our own
/// page's: so the names themselves are looked at.

#include <string>

namespace s4tp::telemetry {

class WebAccess {
 public:
  /// \param address  the server listens on, "127.0.0.1", "0.0.0.0" \param port  1 .. 65535
  WebAccess(std::string address, int port) : address_(std::move(address)), port_(port) {}

  /// VIEW-020 Of a Host header: our port, and a loopback name or the address listened on. Where that is any
  /// address, every address in digits: those belong to no stranger's name.
  [[nodiscard]] bool takes_host(const std::string& host) const;

  /// VIEW-021 Of an Origin header: the same place as Host. Empty, from no page: yes.
  [[nodiscard]] bool takes_origin(const std::string& origin, const std::string& host) const;

 private:
  std::string address_;
  int port_;
};

}  // namespace s4tp::telemetry
