#include "sim_host/telemetry/web_server.hpp"

#include <algorithm>
#include <stdexcept>

namespace s4tp::telemetry {
namespace {

constexpr std::size_t kHeadBytes = 1024;

std::string header(lws* connection, lws_token_indexes token) {
  char text[256];
  const int length = lws_hdr_copy(connection, text, sizeof text, token);
  return length > 0 ? std::string(text, static_cast<std::size_t>(length)) : std::string();
}

bool said(lws* connection, lws_token_indexes token) {
  return lws_hdr_total_length(connection, token) > 0;
}

}  // namespace

WebServer::WebServer(const std::string& address, int port, std::string page, std::size_t kept)
    : page_(std::move(page)), kept_(kept) {
  lws_set_log_level(0, nullptr);
  protocols_[0] = {"http", on_http, 0, 0, 0, nullptr, 0};
  protocols_[1] = {"s4tp-live", on_socket, sizeof(Reader), 0, 0, nullptr, 0};
  lws_context_creation_info info = {};
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  info.user = this;
  info.gid = info.uid = static_cast<decltype(info.gid)>(-1);
  context_ = lws_create_context(&info);
  if (context_ == nullptr) throw std::runtime_error("the web server cannot be started");
  info.port = port;
  info.iface = address.c_str();
  info.protocols = protocols_;
  info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  if (address.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  host_ = lws_create_vhost(context_, &info);
  port_ = host_ == nullptr ? 0 : lws_get_vhost_listen_port(host_);
  if (port_ <= 0) {
    lws_context_destroy(context_);
    throw std::runtime_error(address + ", port " + std::to_string(port) +
                             ": cannot be listened on; another view may be open there (--port takes another "
                             "one, 0 any that is free)");
  }
  access_ = std::make_unique<WebAccess>(address, port_);
}

WebServer::~WebServer() {
  lws_context_destroy(context_);
}

void WebServer::publish(std::string message) {
  messages_.push_back(std::move(message));
  while (messages_.size() > kept_) {
    messages_.pop_front();
    ++first_;
  }
  lws_callback_on_writable_all_protocol(context_, &protocols_[1]);
}

void WebServer::set_state(std::string state) {
  if (state == state_) return;
  state_ = std::move(state);
  ++state_version_;
  lws_callback_on_writable_all_protocol(context_, &protocols_[1]);
}

void WebServer::run(std::uint64_t period_us, const std::function<bool()>& work) {
  work_ = work;
  period_us_ = period_us;
  timer_.server = this;
  on_timer(&timer_.entry);
  while (goes_on_ && lws_service(context_, 0) >= 0) {
  }
  lws_sul_cancel(&timer_.entry);
}

void WebServer::on_timer(lws_sorted_usec_list_t* entry) {
  WebServer& self = *lws_container_of(entry, Timer, entry)->server;
  self.goes_on_ = self.work_();
  lws_sul_schedule(self.context_, 0, entry, on_timer, static_cast<lws_usec_t>(self.period_us_));
  if (!self.goes_on_) lws_cancel_service(self.context_);
}

bool WebServer::welcome(lws* connection) const {
  const std::string host = header(connection, WSI_TOKEN_HOST);
  const std::string origin = header(connection, WSI_TOKEN_ORIGIN);
  // A header too long to be copied is none of ours.
  return access_->takes_host(host) && (!origin.empty() || !said(connection, WSI_TOKEN_ORIGIN)) &&
         access_->takes_origin(origin, host);
}

int WebServer::on_http(lws* connection, lws_callback_reasons reason, void* user, void* in,
                       std::size_t length) {
  auto* const self = static_cast<WebServer*>(lws_context_user(lws_get_context(connection)));
  switch (reason) {
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
      if (self->welcome(connection) && header(connection, WSI_TOKEN_PROTOCOL) == self->protocols_[1].name)
        return 0;
      return lws_return_http_status(connection, HTTP_STATUS_FORBIDDEN, nullptr) < 0 ? -1 : 1;
    case LWS_CALLBACK_HTTP:
      return self->send_page(connection, std::string(static_cast<const char*>(in), length));
    case LWS_CALLBACK_HTTP_WRITEABLE:
      if (self->write(connection, self->page_) < 0) return -1;
      return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
    default:
      return lws_callback_http_dummy(connection, reason, user, in, length);
  }
}

int WebServer::send_page(lws* connection, const std::string& path) {
  unsigned status = HTTP_STATUS_OK;
  if (!welcome(connection)) {
    status = HTTP_STATUS_FORBIDDEN;
  } else if (!said(connection, WSI_TOKEN_GET_URI)) {
    status = HTTP_STATUS_METHOD_NOT_ALLOWED;
  } else if (path != "/") {
    status = HTTP_STATUS_NOT_FOUND;
  }
  if (status != HTTP_STATUS_OK) {
    if (lws_return_http_status(connection, status, nullptr) < 0) return -1;
    return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
  }
  unsigned char head[LWS_PRE + kHeadBytes];
  unsigned char* const begin = head + LWS_PRE;
  unsigned char* at = begin;
  unsigned char* const end = head + sizeof head;
  const auto add = [&](const char* name, const std::string& value) {
    return lws_add_http_header_by_name(connection, reinterpret_cast<const unsigned char*>(name),
                                       reinterpret_cast<const unsigned char*>(value.c_str()),
                                       static_cast<int>(value.size()), &at, end) == 0;
  };
  if (lws_add_http_common_headers(connection, status, "text/html; charset=utf-8", page_.size(), &at, end) !=
          0 ||
      !add("cache-control:", "no-store") || !add("x-content-type-options:", "nosniff") ||
      !add("x-frame-options:", "DENY") || !add("cross-origin-resource-policy:", "same-origin") ||
      lws_finalize_write_http_header(connection, begin, &at, end) != 0) {
    return -1;
  }
  lws_callback_on_writable(connection);
  return 0;
}

int WebServer::on_socket(lws* connection, lws_callback_reasons reason, void* user, void*, std::size_t) {
  auto* const self = static_cast<WebServer*>(lws_context_user(lws_get_context(connection)));
  auto* const reader = static_cast<Reader*>(user);
  switch (reason) {
    case LWS_CALLBACK_ESTABLISHED:
      *reader = {self->first_, 0, true};
      ++self->readers_;
      lws_callback_on_writable(connection);
      return 0;
    case LWS_CALLBACK_CLOSED:
      if (reader->counted) --self->readers_;
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return -1;  // a page has nothing to say
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return self->send_next(connection, *reader);
    default:
      return 0;
  }
}

int WebServer::send_next(lws* connection, Reader& reader) {
  const std::uint64_t end = first_ + messages_.size();
  reader.next = std::max(reader.next, first_);
  if (reader.state_version != state_version_) {
    reader.state_version = state_version_;
    if (write(connection, state_) < 0) return -1;
  } else if (reader.next < end) {
    if (write(connection, messages_[static_cast<std::size_t>(reader.next++ - first_)]) < 0) return -1;
  }
  if (reader.next < end || reader.state_version != state_version_) lws_callback_on_writable(connection);
  return 0;
}

int WebServer::write(lws* connection, const std::string& text) {
  room_.resize(LWS_PRE + text.size());
  std::copy(text.begin(), text.end(), room_.begin() + LWS_PRE);
  const bool page = &text == &page_;
  return lws_write(connection, room_.data() + LWS_PRE, text.size(),
                   page ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_TEXT);
}

}  // namespace s4tp::telemetry
