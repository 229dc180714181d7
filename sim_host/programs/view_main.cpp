// What an ECU process tells through shared memory, as a page for a browser: s4tp-view [--ecu /NAME]
// Exit codes: 0 told to stop, 2 wrong use or an address that cannot be listened on.

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <string>

#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/telemetry/live_cycle.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/telemetry/web_server.hpp"
#include "sim_host/view/html.hpp"

namespace {

using namespace s4tp;

constexpr std::uint64_t kLook_us = 5000;
constexpr std::size_t kKeptCycles = 1800;  // 3 minutes, as long as a page keeps

std::uint64_t now_ms() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

/// Looks at the ECU and tells the pages.
class LiveView {
 public:
  LiveView(const std::string& ecu, telemetry::WebServer& server) : watch_(ecu), server_(server) {}

  void look() {
    const telemetry::News news = watch_.look();
    if (news.another_ecu) ++ecus_;
    tell_state();
    if (news.plan && watch_.cycle() != nullptr) tell_cycle(*watch_.cycle());
  }

 private:
  void tell_state() {
    nlohmann::ordered_json state{
        {"kind", "state"}, {"present", watch_.present()}, {"absence", watch_.absence()}};
    if (watch_.present()) {
      state["ecu"] = telemetry::ecu_json(watch_.identity(), watch_.control(), watch_.status());
      state["process"] = watch_.writer();
    }
    // What changes all the time comes with the cycles, or ten times less often.
    const std::string kept = state.value("present", false)
                                 ? state["ecu"]["mode"].get<std::string>() + state["ecu"]["faults"].dump()
                                 : watch_.absence();
    if (kept == told_ && ++looks_ % 100 != 0) return;
    told_ = kept;
    server_.set_state(state.dump());
  }

  void tell_cycle(const telemetry::CycleRecord& cycle) {
    const std::uint64_t read_ms = now_ms();
    const Parameters& parameters = watch_.identity().parameters;
    // The picture takes tens of milliseconds: for who looks.
    const auto risk =
        server_.readers() > 0
            ? std::make_unique<sadrf::HeatMap>(telemetry::heat_map_of(watch_.plan(), cycle, parameters))
            : nullptr;
    nlohmann::ordered_json json{{"kind", "cycle"}, {"number", ++number_}, {"ecu_number", ecus_}};
    json.update(telemetry::cycle_json(watch_.plan(), cycle, watch_.ecu(), parameters, risk.get()));
    json["ecu"] = telemetry::ecu_json(watch_.identity(), watch_.control(), watch_.status());
    json["at"] = read_ms;
    server_.publish(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }

  telemetry::Watch watch_;
  telemetry::WebServer& server_;
  std::string told_;
  std::uint64_t looks_ = 0;
  std::uint64_t number_ = 0;
  int ecus_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::string ecu = telemetry::kDefaultName;
  std::string address = "127.0.0.1";
  int port = 8470;
  CLI::App app{"a running ECU as a page for a browser (docs/view.md)"};
  app.add_option("--ecu", ecu, "its shared memory (default /s4tp_ecu)");
  app.add_option("--port", port, "of the page (default 8470; 0: any that is free)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--listen", address,
                 "address to listen on (default 127.0.0.1: this machine only; with another one whoever "
                 "reaches it sees the page)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::atomic<bool>& stop = processes::stop_on_signals();
    const view::Page page{
        "s4tp, live", view::kLiveHtml, "", {view::kCanvasJs, view::kSceneJs, view::kLiveJs}};
    telemetry::WebServer server(address, port, view::page_text(page, "img-src data:; connect-src 'self'"),
                                kKeptCycles);
    std::cout << "the running ECU, live: http://" << (address == "0.0.0.0" ? "127.0.0.1" : address) << ':'
              << server.port() << "/   (Ctrl-C ends)" << std::endl;
    LiveView live(ecu, server);
    server.run(kLook_us, [&] {
      live.look();
      return !stop;
    });
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "s4tp-view: " << error.what() << '\n';
    return 2;
  }
}
