#include "sim_host/telemetry/web_access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

namespace s4tp::telemetry {
namespace {

constexpr const char* kHttpPort = "80";  // where none is named

bool is_address(const std::string& name) {
  in_addr four{};
  in6_addr six{};
  if (inet_pton(AF_INET, name.c_str(), &four) == 1) return true;
  return name.size() > 2 && name.front() == '[' && name.back() == ']' &&
         inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), &six) == 1;
}

bool is_any(const std::string& address) {
  return address == "0.0.0.0" || address == "::";
}

}  // namespace

bool WebAccess::takes_host(const std::string& host) const {
  const std::size_t colon = host.rfind(':');
  const bool has_port = colon != std::string::npos && host.find(']', colon) == std::string::npos;
  std::string name = host.substr(0, has_port ? colon : std::string::npos);
  if ((has_port ? host.substr(colon + 1) : kHttpPort) != std::to_string(port_)) return false;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name == "localhost" || name == "127.0.0.1" || name == "[::1]") return true;
  return is_any(address_) ? is_address(name) : name == address_ || name == '[' + address_ + ']';
}

bool WebAccess::takes_origin(const std::string& origin, const std::string& host) const {
  return origin.empty() || origin == "http://" + host;
}

}  // namespace s4tp::telemetry
