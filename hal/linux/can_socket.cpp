#include "hal/linux/can_socket.hpp"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <stdio.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "hal/linux/controller_restart.hpp"

namespace s4tp::hal::linux_host {
namespace {

// Room for a few frames only: what does not go out waits in our queue, where it is seen.
constexpr int kSendBufferBytes = 4096;
constexpr int kReceiveBufferBytes = 1 << 20;  // as much of it as the system allows
constexpr can_err_mask_t kReports = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_TRX |
                                    CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;

bool fail(Reason& reason, const char* name, const char* what) {
  snprintf(reason.text, sizeof reason.text, "%s: %s: %s", name, what, strerror(errno));
  return false;
}

ControllerReport report_of(const can_frame& frame) {
  constexpr std::uint8_t kOverflow = CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW;
  constexpr std::uint8_t kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  const std::uint8_t controller = (frame.can_id & CAN_ERR_CRTL) != 0 ? frame.data[1] : std::uint8_t{0};
  ControllerReport report;
  report.bus_off = (frame.can_id & CAN_ERR_BUSOFF) != 0;
  report.passive = (controller & kPassive) != 0;
  report.active = (frame.can_id & CAN_ERR_RESTARTED) != 0 || (controller & CAN_ERR_CRTL_ACTIVE) != 0;
  report.overflow = (controller & kOverflow) != 0;
  return report;
}

/// Time and drop count that came beside the frame. \return the socket's drop count, `before` when there is
/// none
std::uint32_t read_control(msghdr& message, std::uint32_t before, std::uint64_t& time_us) {
  std::uint32_t lost = before;
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMP) {
      timeval time{};
      memcpy(&time, CMSG_DATA(part), sizeof time);
      time_us =
          static_cast<std::uint64_t>(time.tv_sec) * 1'000'000U + static_cast<std::uint64_t>(time.tv_usec);
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      memcpy(&lost, CMSG_DATA(part), sizeof lost);
    }
  }
  return lost;
}

std::uint64_t clock_us(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000U +
         static_cast<std::uint64_t>(now.tv_nsec) / 1000U;
}

}  // namespace

CanSocket::CanSocket() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {}

CanSocket::~CanSocket() {
  close();
  if (epoll_ >= 0) ::close(epoll_);
}

void CanSocket::configure(const char* name, const CanSocketOptions& options) {
  strncpy(name_, name, sizeof name_ - 1);
  id_count_ = options.id_count < kIdsMax ? options.id_count : kIdsMax;
  for (int i = 0; i < id_count_; ++i) ids_[i] = options.ids[i];
  believe_local_reports_ = options.believe_local_reports;
}

void CanSocket::adopt(int descriptor) {
  socket_ = descriptor;
}

bool CanSocket::open(Reason& reason) {
  if (socket_ < 0) {
    lost_ = 0;
    socket_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (socket_ < 0) {
      if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
        snprintf(reason.text, sizeof reason.text,
                 "%s: this system's kernel has no CAN (modprobe can-raw; or run in the machine with --vm)",
                 name_);
        return false;
      }
      return fail(reason, name_, "no socket");
    }
    if (!set_up(reason)) {
      close();
      return false;
    }
  }
  epoll_event event{};
  event.events = EPOLLIN;
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, socket_, &event) != 0) {
    fail(reason, name_, "epoll");
    close();
    return false;
  }
  return true;
}

bool CanSocket::set_up(Reason& reason) {
  can_filter filters[kIdsMax];
  const int count = id_count_ == 0 ? 1 : id_count_;
  for (int i = 0; i < count; ++i) {  // the kind of frame is a part of its name
    filters[i].can_id = id_count_ == 0 ? 0 : ids_[i];
    filters[i].can_mask = CAN_EFF_FLAG | CAN_RTR_FLAG | (id_count_ == 0 ? 0 : CAN_SFF_MASK);
  }
  const int on = 1;
  const can_err_mask_t reports = kReports;
  const auto option = [this](int level, int name, const void* value, std::size_t size) {
    return setsockopt(socket_, level, name, value, static_cast<socklen_t>(size)) == 0;
  };
  if (!option(SOL_CAN_RAW, CAN_RAW_FILTER, filters, sizeof filters[0] * static_cast<std::size_t>(count)) ||
      !option(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &reports, sizeof reports)) {
    return fail(reason, name_, "filters");
  }
  static_cast<void>(option(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on));  // the MTU says whether it helps
  static_cast<void>(option(SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes));
  if (!option(SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBufferBytes, sizeof kReceiveBufferBytes))  // root's
    static_cast<void>(option(SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes));
  if (!option(SOL_SOCKET, SO_TIMESTAMP, &on, sizeof on) || !option(SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on)) {
    return fail(reason, name_, "times and drop counts");
  }
  ifreq request{};
  memcpy(request.ifr_name, name_, sizeof name_);
  if (ioctl(socket_, SIOCGIFINDEX, &request) != 0) return fail(reason, name_, "no such interface");
  index_ = request.ifr_ifindex;
  if (ioctl(socket_, SIOCGIFMTU, &request) != 0) return fail(reason, name_, "no MTU");
  flexible_ = request.ifr_mtu >= static_cast<int>(CANFD_MTU);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return fail(reason, name_, errno == ENODEV ? "not a CAN interface" : "cannot be bound");
  }
  return true;
}

void CanSocket::close() {
  if (socket_ >= 0) ::close(socket_);  // epoll forgets it by itself
  socket_ = -1;
}

ReadResult CanSocket::read(Reading& reading) {
  canfd_frame frame{};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(timeval)) + CMSG_SPACE(sizeof(std::uint32_t))];
  iovec part{&frame, sizeof frame};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = recvmsg(socket_, &message, MSG_DONTWAIT);
  if (size < 0) {
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? ReadResult::kNothing
                                                                     : ReadResult::kFailed;
  }
  if (size == 0) return ReadResult::kFailed;
  reading.time_us = clock_us(CLOCK_REALTIME);
  const std::uint32_t lost = read_control(message, lost_, reading.time_us);
  reading.lost = lost - lost_;
  lost_ = lost;
  reading.local = (message.msg_flags & MSG_DONTROUTE) != 0;
  if (size != static_cast<ssize_t>(CAN_MTU) && size != static_cast<ssize_t>(CANFD_MTU))
    return ReadResult::kForeign;
  if ((frame.can_id & CAN_ERR_FLAG) != 0) {
    if (reading.local && !believe_local_reports_) return ReadResult::kForeign;
    can_frame report{};
    memcpy(&report, &frame, sizeof report);
    reading.report = report_of(report);
    return ReadResult::kReport;
  }
  if ((frame.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0 || frame.len > CANFD_MAX_DLEN)
    return ReadResult::kForeign;
  reading.frame.id = frame.can_id & CAN_SFF_MASK;
  reading.frame.length = frame.len;
  memcpy(reading.frame.data, frame.data, frame.len);
  return ReadResult::kFrame;
}

WriteResult CanSocket::write(const CanFrame& frame) {
  const bool flexible = frame.length > CAN_MAX_DLEN;
  if (flexible && !flexible_) return WriteResult::kRefused;
  canfd_frame out{};  // begins like a can_frame
  out.can_id = frame.id;
  out.len = frame.length;
  memcpy(out.data, frame.data, frame.length);
  if (::send(socket_, &out, flexible ? CANFD_MTU : CAN_MTU, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) {
    return WriteResult::kSent;
  }
  switch (errno) {
    case EAGAIN:
    case ENOBUFS:
    case EINTR:
      return WriteResult::kFull;
    case EINVAL:
    case EMSGSIZE:
      return WriteResult::kRefused;
    default:
      return WriteResult::kFailed;
  }
}

bool CanSocket::wait(int timeout_ms) {
  epoll_event event{};
  return epoll_wait(epoll_, &event, 1, timeout_ms) > 0;
}

LinkState CanSocket::look() {
  if (index_ == 0) return LinkState::kUp;  // adopted: no interface to look at
  ifreq request{};
  memcpy(request.ifr_name, name_, sizeof name_);
  if (ioctl(socket_, SIOCGIFINDEX, &request) != 0 || request.ifr_ifindex != index_) {
    ifreq renamed{};
    renamed.ifr_ifindex = index_;
    return ioctl(socket_, SIOCGIFNAME, &renamed) == 0 ? LinkState::kRenamed : LinkState::kGone;
  }
  if (ioctl(socket_, SIOCGIFFLAGS, &request) != 0) return LinkState::kGone;
  return (request.ifr_flags & IFF_UP) != 0 ? LinkState::kUp : LinkState::kDown;
}

bool CanSocket::restart() {
  return index_ != 0 && restart_controller(index_);
}

std::uint64_t CanSocket::now_ms() const {
  return clock_us(CLOCK_MONOTONIC) / 1000U;
}

}  // namespace s4tp::hal::linux_host
