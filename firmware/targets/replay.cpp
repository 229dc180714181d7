#include "firmware/targets/replay.hpp"

#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"
#include "firmware/wire/candump.hpp"
#include "firmware/wire/codec.hpp"

namespace s4tp::targets {
namespace {

bool same(const wire::Frame& a, const wire::Frame& b) {
  bool equal = a.id == b.id && a.length == b.length;
  for (int i = 0; i < 8; ++i) equal = equal && a.data[i] == b.data[i];
  return equal;
}

/// What the DBC says about an id; null for a foreign one.
const wire::MessageInfo* find_message(std::uint32_t id) {
  for (const wire::MessageInfo& message : wire::kMessages) {
    if (message.id == id) return &message;
  }
  return nullptr;
}

bool sent_by_ecu(const wire::Frame& frame) {
  const wire::MessageInfo* const message = find_message(frame.id);
  return message != nullptr && message->sender[0] == 'E';
}

void append(Text& line, const wire::Frame* frame) {
  if (frame == nullptr) {
    line << "nothing";
    return;
  }
  const wire::MessageInfo* const message = find_message(frame->id);
  line << (message == nullptr ? "unknown" : message->name) << " ";
  line.hex(frame->id, 3) << "#";
  for (int i = 0; i < frame->length && i < 8; ++i) line.hex(frame->data[i], 2);
}

bool starts_with(const char* text, int size, const char* start) {
  int i = 0;
  while (start[i] != '\0' && i < size && text[i] == start[i]) ++i;
  return start[i] == '\0';
}

/// The decimal number after `name` anywhere in the text. \return false when there is none
bool find_number(const char* text, int size, const char* name, std::uint32_t& number) {
  for (int i = 0; i < size; ++i) {
    if (!starts_with(text + i, size - i, name)) continue;
    while (i < size && (text[i] < '0' || text[i] > '9')) ++i;
    if (i == size) return false;
    number = 0;
    for (; i < size && text[i] >= '0' && text[i] <= '9'; ++i) {
      number = number * 10 + static_cast<std::uint32_t>(text[i] - '0');
    }
    return true;
  }
  return false;
}

}  // namespace

bool FrameQueue::push(const wire::Frame& frame) {
  if (size_ == kCapacity) return false;
  frames_[(first_ + size_++) % kCapacity] = frame;
  return true;
}

bool FrameQueue::pop(wire::Frame& frame) {
  if (size_ == 0) return false;
  frame = frames_[first_];
  first_ = (first_ + 1) % kCapacity;
  --size_;
  return true;
}

bool LogCan::receive(hal::CanFrame& frame) {
  wire::Frame next;
  if (!to_ecu.pop(next)) return false;
  frame = {};
  frame.id = next.id;
  frame.length = next.length;
  for (int i = 0; i < 8; ++i) frame.data[i] = next.data[i];
  ++counters_.received;
  return true;
}

bool LogCan::send(const hal::CanFrame& frame) {
  wire::Frame sent;
  sent.id = frame.id;
  sent.length = frame.length;
  for (int i = 0; i < 8; ++i) sent.data[i] = frame.data[i];
  const bool taken = frame.length <= 8 && from_ecu.push(sent);
  ++(taken ? counters_.sent : counters_.dropped);
  return taken;
}

bool Replay::init(const Parameters& parameters) {
  parameters_crc_ = parameters_crc(parameters);
  ecu::Ports ports;
  ports.can = &can_;
  ports.cycles = &cycles_;
  ports.watchdog = &watchdog_;
  return ecu_.init(parameters, ports) == Status::kOk;
}

void Replay::line(const char* text, int size) {
  ++lines_;
  if (size > 0 && text[0] == '#') {
    comment(text, size);
    return;
  }
  wire::LoggedFrame logged;
  const wire::CandumpResult result = wire::parse_candump(text, size, logged);
  if (result == wire::CandumpResult::kSkipped) return;
  if (result == wire::CandumpResult::kMalformed) {
    invalid("malformed line");
    return;
  }
  if (sent_by_ecu(logged.frame)) {
    compare(logged.frame);
    return;
  }
  if (!can_.to_ecu.push(logged.frame)) invalid("too many frames in a tick");
  if (logged.frame.id == wire::kTickId) tick();
}

void Replay::comment(const char* text, int size) {
  std::uint32_t crc = 0;
  if (starts_with(text, size, "# miss")) {
    ++misses_;
    ecu_.inject_deadline_miss();
  } else if (starts_with(text, size, "# s4tp log:") && find_number(text, size, "parameters ", crc) &&
             crc != parameters_crc_) {
    invalid("driven with other parameters");
  }
}

void Replay::tick() {
  expect_nothing_left();
  ++ticks_;
  ecu_.control_tick();
  if (!ecu_.planning_due()) return;
  ecu_.planning_cycle();
  ++planning_cycles_;
}

void Replay::finish() {
  expect_nothing_left();
}

void Replay::compare(const wire::Frame& recorded) {
  wire::Frame sent;
  const bool any = can_.from_ecu.pop(sent);
  ++compared_;
  if (!any || !same(recorded, sent)) differs(&recorded, any ? &sent : nullptr);
  if (!any) return;
  crc_ = crc32_byte(crc_, sent.id);
  crc_ = crc32_byte(crc_, sent.id >> 8U);
  for (int i = 0; i < sent.length; ++i) crc_ = crc32_byte(crc_, sent.data[i]);
}

void Replay::expect_nothing_left() {
  wire::Frame sent;
  while (can_.from_ecu.pop(sent)) differs(nullptr, &sent);
}

void Replay::differs(const wire::Frame* recorded, const wire::Frame* sent) {
  if (differences_++ > 0) return;
  Text text;
  text << "first difference at tick " << ticks_ << ", planning cycle " << planning_cycles_ << ", line "
       << lines_;
  text << ": recorded ";
  append(text, recorded);
  text << ", now ";
  append(text, sent);
  text << "\n";
  print(text.c_str());
}

void Replay::invalid(const char* reason) {
  if (valid_) {
    Text text;
    text << "line " << lines_ << ": " << reason << "\n";
    print(text.c_str());
  }
  valid_ = false;
}

void Replay::print_summary() const {
  Text text;
  text << ticks_ << " ticks, " << planning_cycles_ << " plans, " << misses_ << " missed, " << compared_
       << " frames compared, ";
  text << differences_ << " differ, CRC ";
  text.hex(~crc_, 8);
  if (stack_used() > 0) text << ", stack " << stack_used() << " bytes";
  text << "\n";
  print(text.c_str());
}

}  // namespace s4tp::targets
