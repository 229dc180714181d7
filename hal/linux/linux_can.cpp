#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

const char* link_news_text(LinkNews news) {
  switch (news) {
    case LinkNews::kNone:
      return "nothing new";
    case LinkNews::kDown:
      return "down";
    case LinkNews::kGone:
      return "gone";
    case LinkNews::kRenamed:
      return "renamed: this bus is gone";
    case LinkNews::kBack:
      return "back";
    case LinkNews::kPassive:
      return "error-passive";
    case LinkNews::kBusOff:
      return "bus-off";
    case LinkNews::kActive:
      return "error-active again";
    case LinkNews::kRestartAsked:
      return "restart of the controller asked for";
    case LinkNews::kRestartRefused:
      return "the controller cannot be restarted from here (rights? ip link set ... type can restart-ms 100)";
  }
  return "?";
}

}  // namespace s4tp::hal::linux_host
