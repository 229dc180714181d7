#include "sim_host/sumo/traci_client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace s4tp::sumo::traci {
namespace {

constexpr int kGetVersion = 0x00;
constexpr int kStep = 0x02;
constexpr int kClose = 0x7F;
constexpr int kGet = 0xA0;  // plus the domain
constexpr int kGot = 0xB0;
constexpr int kSet = 0xC0;
constexpr int kSubscribe = 0xD0;
constexpr int kEvent = 0xE0;
constexpr int kOk = 0x00;
constexpr double kFirst_s = -1073741824.0;  // SUMO's own word for "from the beginning" and "until the end"
constexpr std::size_t kLongestAnswer = 16U << 20U;

std::string hexadecimal(int value) {
  std::ostringstream text;
  text << "0x" << std::hex << value;
  return text.str();
}

std::string described(const char* what, int variable, const std::string& object) {
  return std::string(what) + ' ' + hexadecimal(variable) + " of \"" + object + '"';
}

void expect(int got, int wanted, const std::string& what) {
  if (got != wanted) {
    throw Error("SUMO's answer to " + what + " holds " + hexadecimal(got) + ", not " + hexadecimal(wanted));
  }
}

Variables read_variables(Reader& event, const std::string& object) {
  Variables variables;
  for (int left = event.byte(); left > 0; --left) {
    const int variable = event.byte();
    const int status = event.byte();
    Value value = event.typed();
    if (status != kOk) {
      const std::string* reason = std::get_if<std::string>(&value);
      throw Error("SUMO cannot observe " + described("variable", variable, object) + ": " +
                  (reason != nullptr ? *reason : "no reason given"));
    }
    variables.emplace(variable, std::move(value));
  }
  return variables;
}

}  // namespace

Client::~Client() {
  ::close(socket_);
}

void Client::wait_for(short events) {
  pollfd waiting{socket_, events, 0};
  int ready = 0;
  do {
    ready = poll(&waiting, 1, static_cast<int>(patience_.count()));
  } while (ready < 0 && errno == EINTR);
  if (ready == 0) {
    throw Error("SUMO has not answered for " + std::to_string(patience_.count()) + " ms");
  }
}

void Client::send(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    wait_for(POLLOUT);
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) {
      throw Error(std::string("SUMO has closed the connection (") + std::strerror(errno) + ")");
    }
    sent += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
}

void Client::receive(std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    wait_for(POLLIN);
    const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
    if (count == 0) {
      throw Error("SUMO has closed the connection");
    }
    if (count < 0 && errno != EINTR) {
      throw Error(std::string("SUMO has closed the connection (") + std::strerror(errno) + ")");
    }
    bytes = bytes.subspan(count > 0 ? static_cast<std::size_t>(count) : 0);
  }
}

Reader Client::exchange(int command, const Writer& content, const std::string& what) {
  send(message(command, content));
  std::uint8_t head[4];
  receive(head);
  const int length = Reader(head).integer();
  if (length < 4 || static_cast<std::size_t>(length) > kLongestAnswer) {
    throw Error("SUMO's answer to " + what + " says it is " + std::to_string(length) + " bytes long");
  }
  answer_.resize(static_cast<std::size_t>(length) - 4);
  receive(answer_);
  Reader answer(answer_);
  Reader status = answer.command();
  expect(status.byte(), command, what);
  const int result = status.byte();
  const std::string words = status.text();
  if (result != kOk) {
    throw Error("SUMO refuses " + what + ": " + (words.empty() ? "no reason given" : words));
  }
  return answer;
}

int Client::version(std::string& name) {
  Reader answer = exchange(kGetVersion, {}, "get version");
  Reader result = answer.command();
  expect(result.byte(), kGetVersion, "get version");
  const int version = result.integer();
  name = result.text();
  return version;
}

Value Client::get(Domain domain, int variable, const std::string& object) {
  const std::string what = described("get", variable, object);
  Reader answer = exchange(kGet + static_cast<int>(domain), Writer().byte(variable).text(object), what);
  Reader result = answer.command();
  expect(result.byte(), kGot + static_cast<int>(domain), what);
  expect(result.byte(), variable, what);
  if (result.text() != object) {
    throw Error("SUMO's answer to " + what + " is about something else");
  }
  return result.typed();
}

void Client::set(Domain domain, int variable, const std::string& object, const Writer& value) {
  (void)exchange(kSet + static_cast<int>(domain), Writer().byte(variable).text(object).append(value),
                 described("set", variable, object));
}

Variables Client::subscribe(Domain domain, const std::string& object, const std::vector<int>& variables) {
  const std::string what = "subscribe to \"" + object + '"';
  Writer content;
  content.real(kFirst_s).real(-kFirst_s).text(object).byte(static_cast<int>(variables.size()));
  for (const int variable : variables) {
    content.byte(variable);
  }
  Reader answer = exchange(kSubscribe + static_cast<int>(domain), content, what);
  Reader event = answer.command();
  expect(event.byte(), kEvent + static_cast<int>(domain), what);
  if (event.text() != object) {
    throw Error("SUMO's answer to " + what + " is about something else");
  }
  return read_variables(event, object);
}

void Client::unsubscribe(Domain domain, const std::string& object) {
  (void)exchange(kSubscribe + static_cast<int>(domain),
                 Writer().real(kFirst_s).real(-kFirst_s).text(object).byte(0),
                 "unsubscribe from \"" + object + '"');
}

std::map<Domain, Observations> Client::step() {
  Reader answer = exchange(kStep, Writer().real(0.0), "step");
  std::map<Domain, Observations> all;
  for (int left = answer.integer(); left > 0; --left) {
    Reader event = answer.command();
    const Domain domain = static_cast<Domain>(event.byte() - kEvent);
    const std::string object = event.text();
    all[domain][object] = read_variables(event, object);
  }
  return all;
}

void Client::close() noexcept {
  try {
    (void)exchange(kClose, {}, "close");
  } catch (...) {  // it ends all the same
  }
}

}  // namespace s4tp::sumo::traci
