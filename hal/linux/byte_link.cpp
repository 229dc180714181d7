#include "hal/linux/byte_link.hpp"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

namespace s4tp::hal::linux_host {
namespace {

struct Rate {
  std::uint32_t baud;
  speed_t code;
};
constexpr Rate kRates[] = {{1'000'000, B1000000}, {1'152'000, B1152000}, {1'500'000, B1500000},
                           {2'000'000, B2000000}, {2'500'000, B2500000}, {3'000'000, B3000000},
                           {3'500'000, B3500000}, {4'000'000, B4000000}};
// Unix98 pseudo terminals (Linux: Documentation/admin-guide/devices.txt).
constexpr unsigned kPtyMajorFirst = 136;
constexpr unsigned kPtyMajorLast = 143;

bool refuse(Reason& reason, const char* place, const char* why) {
  snprintf(reason.text, sizeof reason.text, "%s: %s", place, why);
  return false;
}

bool is_pty(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISCHR(status.st_mode)) return false;
  const unsigned device = major(status.st_rdev);
  return device >= kPtyMajorFirst && device <= kPtyMajorLast;
}

/// Raw line, at `baud` unless that is 0. \return false when the device does not take it
bool set_line(int descriptor, std::uint32_t baud) {
  termios line{};
  if (tcgetattr(descriptor, &line) != 0) return false;
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~(static_cast<tcflag_t>(CRTSCTS) | CSTOPB);
  speed_t code = cfgetospeed(&line);
  if (baud != 0) {
    const Rate* rate = nullptr;
    for (const Rate& one : kRates) {
      if (one.baud == baud) rate = &one;
    }
    if (rate == nullptr) return false;
    code = rate->code;
    if (cfsetispeed(&line, code) != 0 || cfsetospeed(&line, code) != 0) return false;
  }
  if (tcsetattr(descriptor, TCSANOW, &line) != 0) return false;
  // tcsetattr is content when any one of the changes worked.
  termios taken{};
  return tcgetattr(descriptor, &taken) == 0 && cfgetospeed(&taken) == code;
}

/// 0.0.0.0 or ::, or the latter around the former.
bool is_every_address(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    return reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr == htonl(INADDR_ANY);
  }
  const in6_addr& six = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  const bool mapped = IN6_IS_ADDR_V4MAPPED(&six) && memcmp(six.s6_addr + 12, "\0\0\0\0", 4) == 0;
  return address.ss_family == AF_INET6 && (IN6_IS_ADDR_UNSPECIFIED(&six) || mapped);
}

void close_and_forget(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

}  // namespace

ByteLink::ByteLink() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {}

ByteLink::~ByteLink() {
  close_and_forget(link_);
  close_and_forget(pending_);
  close_and_forget(listener_);
  close_and_forget(epoll_);
}

bool ByteLink::open(const BusName& name, Reason& reason) {
  name_ = name;
  switch (name.kind) {
    case BusKind::kTcp:
      return resolve(reason) && (connect(), true);
    case BusKind::kListen:
      return resolve(reason) && listen(reason);
    case BusKind::kPty:
    case BusKind::kTty:
      link_ = open_device(reason);
      if (link_ >= 0) watch(link_);
      return link_ >= 0;
    case BusKind::kInterface:
      break;
  }
  return refuse(reason, name.place, "no serial line");
}

bool ByteLink::resolve(Reason& reason) {
  char port[8];
  snprintf(port, sizeof port, "%u", unsigned{name_.port});
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = name_.kind == BusKind::kListen ? AI_PASSIVE : 0;
  const bool anyone = name_.kind == BusKind::kListen && strcmp(name_.place, kAnyone) == 0;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(anyone ? nullptr : name_.place, port, &hints, &found); error != 0) {
    return refuse(reason, name_.place, gai_strerror(error));
  }
  memcpy(&address_, found->ai_addr, found->ai_addrlen);
  address_size_ = found->ai_addrlen;
  freeaddrinfo(found);
  if (name_.kind == BusKind::kListen && !anyone && is_every_address(address_)) {
    return refuse(reason, name_.place,
                  "whoever reaches this machine could drive; if that is meant: slcan:listen:anyone:PORT");
  }
  return true;
}

bool ByteLink::listen(Reason& reason) {
  listener_ = socket(address_.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (listener_ < 0 || setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(listener_, reinterpret_cast<const sockaddr*>(&address_), address_size_) != 0 ||
      ::listen(listener_, 1) != 0) {
    return refuse(reason, name_.place, strerror(errno));
  }
  watch(listener_);
  return true;
}

int ByteLink::open_device(Reason& reason) {
  const int device = ::open(name_.place, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const char* why = nullptr;
  if (device < 0) {
    why = strerror(errno);
  } else if (name_.kind == BusKind::kPty && !is_pty(device)) {
    why = "not a pseudo terminal; a serial port is slcan:tty:PATH@BAUD";
  } else if (!set_line(device, name_.baud)) {
    why = "the line does not take this rate (tried of 1000000, 1152000, 1500000, 2000000 .. 4000000)";
  }
  if (why == nullptr) return device;
  static_cast<void>(refuse(reason, name_.place, why));
  if (device >= 0) ::close(device);
  return -1;
}

bool ByteLink::connect() {
  if (link_ >= 0) return true;
  const int on = 1;
  if (name_.kind == BusKind::kListen) {
    link_ = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  } else if (name_.kind == BusKind::kTcp) {
    if (pending_ < 0) pending_ = socket(address_.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    // Asked again, it answers how the first attempt went.
    const bool made = ::connect(pending_, reinterpret_cast<const sockaddr*>(&address_), address_size_) == 0;
    if (made || errno == EISCONN) {
      link_ = pending_;
      pending_ = -1;
    } else if (errno != EINPROGRESS && errno != EALREADY) {
      close_and_forget(pending_);
    }
  } else {
    Reason reason;
    link_ = open_device(reason);
  }
  if (link_ < 0) return false;
  if (name_.port != 0) setsockopt(link_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  // One peer at a time: the next one waits unseen until this one is gone.
  if (listener_ >= 0) static_cast<void>(epoll_ctl(epoll_, EPOLL_CTL_DEL, listener_, nullptr));
  watch(link_);
  return true;
}

void ByteLink::watch(int descriptor) {
  epoll_event event{};
  event.events = EPOLLIN;
  static_cast<void>(epoll_ctl(epoll_, EPOLL_CTL_ADD, descriptor, &event));
}

void ByteLink::lose() {
  close_and_forget(link_);
  if (listener_ >= 0) watch(listener_);
}

int ByteLink::failed(int error) {
  if (error != EAGAIN && error != EWOULDBLOCK && error != EINTR) lose();
  return 0;
}

int ByteLink::read(char* bytes, int size) {
  if (link_ < 0) return 0;
  const ssize_t count = ::read(link_, bytes, static_cast<std::size_t>(size));
  if (count > 0) return static_cast<int>(count);
  return failed(count < 0 ? errno : EPIPE);
}

int ByteLink::write(const char* bytes, int size) {
  if (link_ < 0) return 0;
  const auto wanted = static_cast<std::size_t>(size);
  const ssize_t count =
      name_.port != 0 ? send(link_, bytes, wanted, MSG_NOSIGNAL) : ::write(link_, bytes, wanted);
  return count >= 0 ? static_cast<int>(count) : failed(errno);
}

bool ByteLink::wait(int timeout_ms) {
  epoll_event event{};
  return epoll_wait(epoll_, &event, 1, timeout_ms) > 0;
}

}  // namespace s4tp::hal::linux_host
