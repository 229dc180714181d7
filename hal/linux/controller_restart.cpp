#include "hal/linux/controller_restart.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

namespace s4tp::hal::linux_host {
namespace {

/// RTM_NEWLINK { interface, LINKINFO { KIND "can", DATA { RESTART 1 } } }, every part in its place.
struct RestartRequest {
  nlmsghdr header;
  ifinfomsg interface;
  rtattr info;
  rtattr kind;
  char kind_name[4];
  rtattr data;
  rtattr restart;
  std::uint32_t on;
};
static_assert(sizeof(RestartRequest) == NLMSG_LENGTH(sizeof(ifinfomsg)) + 4 * RTA_LENGTH(0) + 8,
              "attributes follow one another without gaps");

rtattr attribute(int type, std::size_t size) {
  rtattr result{};
  result.rta_type = static_cast<unsigned short>(type);
  result.rta_len = static_cast<unsigned short>(size);
  return result;
}

}  // namespace

bool restart_controller(int interface_index) {
  RestartRequest request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_NEWLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK;
  request.interface.ifi_index = interface_index;
  request.on = 1;
  request.restart = attribute(IFLA_CAN_RESTART, RTA_LENGTH(sizeof request.on));
  request.data = attribute(IFLA_INFO_DATA, RTA_LENGTH(request.restart.rta_len));
  request.kind = attribute(IFLA_INFO_KIND, RTA_LENGTH(sizeof request.kind_name));
  memcpy(request.kind_name, "can", sizeof request.kind_name);
  request.info = attribute(
      IFLA_LINKINFO, static_cast<std::size_t>(RTA_LENGTH(0)) + request.kind.rta_len + request.data.rta_len);

  const int netlink = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (netlink < 0) return false;
  struct {
    nlmsghdr header;
    nlmsgerr error;
  } answer{};
  // The kernel answers before send() returns.
  const bool answered = send(netlink, &request, sizeof request, 0) == static_cast<ssize_t>(sizeof request) &&
                        recv(netlink, &answer, sizeof answer, MSG_DONTWAIT) > 0;
  close(netlink);
  return answered && answer.header.nlmsg_type == NLMSG_ERROR && answer.error.error == 0;
}

}  // namespace s4tp::hal::linux_host
