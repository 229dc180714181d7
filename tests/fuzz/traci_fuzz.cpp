// SUMO's answers: whatever bytes come, a value or an Error.

#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <iterator>
#include <string>
#include <vector>

#include "sim_host/sumo/traci_client.hpp"
#include "tests/fuzz/input.hpp"

using namespace s4tp;
using namespace s4tp::sumo;
using fuzz::expect;
using fuzz::Input;

namespace {

/// As one message of SUMO's, its status in front: most inputs would not get past these.
std::vector<std::uint8_t> framed(int command, const std::string& content) {
  const traci::Writer status = traci::Writer().byte(7).byte(command).byte(0).text("");
  std::vector<std::uint8_t> bytes = traci::Writer()
                                        .integer(static_cast<int>(4 + status.bytes().size() + content.size()))
                                        .append(status)
                                        .bytes();
  bytes.insert(bytes.end(), content.begin(), content.end());
  return bytes;
}

/// One command, answered with what the input holds.
void ask(int what, traci::Client& client) {
  using traci::Domain;
  std::string name;
  switch (what) {
    case 0:
      static_cast<void>(client.version(name));
      break;
    case 1:
      static_cast<void>(client.get(Domain::kVehicle, traci::kSpeed, "a"));
      break;
    case 2:
      client.set(Domain::kVehicle, traci::kSpeedMode, "a", traci::Writer().typed_integer(0));
      break;
    case 3:
      static_cast<void>(client.subscribe(Domain::kVehicle, "a", {traci::kSpeed, traci::kPosition}));
      break;
    case 4:
      client.unsubscribe(Domain::kVehicle, "a");
      break;
    case 5:
      client.close();
      break;
    default:
      static_cast<void>(client.step());
  }
}

constexpr int kCommands[] = {0x00, 0xA4, 0xC4, 0xD4, 0xD4, 0x7F, 0x02};

void over_a_socket(Input& input) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return;
  const int what = input.below(static_cast<int>(std::size(kCommands)));
  const bool whole = input.below(8) != 7;
  const std::string content = input.rest();
  const std::vector<std::uint8_t> bytes =
      whole ? framed(kCommands[what], content) : std::vector<std::uint8_t>(content.begin(), content.end());
  {
    traci::Client client(ends[0], std::chrono::milliseconds(100));
    if (::send(ends[1], bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) {
      shutdown(ends[1], SHUT_WR);
      try {
        ask(what, client);
      } catch (const traci::Error& error) {
        expect(std::string(error.what()).find("SUMO") != std::string::npos,
               "an error says whose answer it was");
      }
    }
  }
  close(ends[1]);
}

traci::Writer written(const traci::Value& value) {
  traci::Writer writer;
  if (const int* whole = std::get_if<int>(&value)) writer.typed_integer(*whole);
  if (const double* real = std::get_if<double>(&value)) writer.typed_real(*real);
  if (const std::string* text = std::get_if<std::string>(&value)) writer.typed_text(*text);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) writer.typed_texts(*texts);
  return writer;  // a position is only ever read
}

/// What is read of a value is written and read again the same.
void values(Input& input) {
  const std::string bytes = input.rest();
  traci::Reader reader({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  try {
    while (!reader.at_end()) {
      const traci::Writer once = written(reader.typed());
      if (once.bytes().empty()) continue;
      traci::Reader again(once.bytes());
      expect(written(again.typed()).bytes() == once.bytes() && again.at_end(),
             "a value written is read as it was");
    }
  } catch (const traci::Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  if (input.below(2) == 0) {
    over_a_socket(input);
  } else {
    values(input);
  }
  return 0;
}
