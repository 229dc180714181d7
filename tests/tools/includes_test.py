"""The include checker sees planted faults, and lets what is right pass."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "toolchain"))
import check_includes  # noqa: E402
from small_project import findings_in  # noqa: E402


def findings(path, text):
    return findings_in(check_includes, {path: text})


class Includes(unittest.TestCase):
    # The world must never see the planner.
    def test_world_including_the_planner_is_found(self):
        found = findings("sim_host/world/world.cpp", '#include "algo/planner/planner.hpp"\n')
        self.assertEqual(len(found), 1)
        self.assertIn("sim_host/world/world.cpp:1", found[0])

    # Down the table it is allowed, up it is not: the gate knows the wire, the wire nobody.
    def test_gate_may_include_wire_but_not_the_other_way(self):
        self.assertEqual(findings("firmware/gate/gate.cpp", '#include "firmware/wire/frame.hpp"\n'), [])
        self.assertEqual(len(findings("firmware/wire/frame.cpp", '#include "firmware/gate/gate.hpp"\n')), 1)

    # The application stands on interfaces, not on a platform.
    def test_ecu_including_a_platform_is_found(self):
        self.assertEqual(findings("firmware/ecu/ecu.cpp", '#include "hal/can.hpp"\n'), [])
        self.assertEqual(len(findings("firmware/ecu/ecu.cpp", '#include "hal/sim/bus.hpp"\n')), 1)

    # An interface that includes an implementation would drag it into everybody.
    def test_interface_including_a_platform_is_found(self):
        self.assertEqual(len(findings("hal/can.hpp", '#include "hal/mps/uart.hpp"\n')), 1)
        self.assertEqual(findings("hal/mps/uart.hpp", '#include "hal/can.hpp"\n'), [])

    # Everybody gets Eigen by way of one header, which routes its assertions and fixes its version.
    def test_eigen_only_by_way_of_one_header(self):
        self.assertEqual(findings("algo/core/linear_algebra.hpp", "#include <Eigen/Core>\n"), [])
        self.assertEqual(len(findings("algo/trajectory/solver.cpp", "#include <Eigen/Core>\n")), 1)
        self.assertEqual(len(findings("firmware/ecu/tracker.cpp", "#include <Eigen/Core>\n")), 1)

    # Containers with a heap and the C mathematics library have no place in the core; on the host they do.
    def test_heap_containers_and_cmath_in_the_core_are_found(self):
        for header in ("vector", "string", "cmath", "iostream", "functional"):
            self.assertEqual(len(findings("algo/core/x.cpp", f"#include <{header}>\n")), 1, header)
            self.assertEqual(findings("sim_host/view/x.cpp", f"#include <{header}>\n"), [], header)

    # A relative path would go around the table.
    def test_relative_include_is_found(self):
        self.assertEqual(len(findings("algo/core/x.cpp", '#include "../scene/scene.hpp"\n')), 1)

    # The guard must not rest on what it guards against: no prediction, no risk field, no candidates.
    def test_guard_including_a_prediction_is_found(self):
        self.assertEqual(findings("algo/safety/guard.cpp", '#include "algo/occupancy/pace.hpp"\n'), [])
        for header in ("satp/prediction.hpp", "sadrf/risk.hpp", "trajectory/candidates.hpp", "planner/planner.hpp"):
            self.assertEqual(len(findings("algo/safety/guard.cpp", f'#include "algo/{header}"\n')), 1, header)

    # Down the order of the core's folders, never up; and a folder without a place in it stands in no room.
    def test_order_of_the_core_is_kept(self):
        self.assertEqual(findings("algo/planner/x.cpp", '#include "algo/safety/guard.hpp"\n'), [])
        self.assertEqual(len(findings("algo/core/x.cpp", '#include "algo/scene/scene.hpp"\n')), 1)
        self.assertEqual(len(findings("algo/scene/x.cpp", '#include "algo/planner/planner.hpp"\n')), 1)
        self.assertEqual(len(findings("algo/cellar/x.cpp", '#include "algo/core/math.hpp"\n')), 1)

    # The world's rooms stand in an order, too: a map knows no cars, and only the whole of it knows SUMO.
    def test_order_of_the_worlds_rooms_is_kept(self):
        self.assertEqual(findings("sim_host/world/traffic/x.cpp", '#include "sim_host/world/map/network.hpp"\n'), [])
        self.assertEqual(len(findings("sim_host/world/map/x.cpp", '#include "sim_host/world/traffic/box.hpp"\n')), 1)
        self.assertEqual(len(findings("sim_host/world/traffic/x.cpp", '#include "sim_host/world/world.hpp"\n')), 1)
        self.assertEqual(findings("sim_host/world/x.cpp", '#include "sim_host/sumo/sumo_traffic.hpp"\n'), [])
        self.assertEqual(len(findings("sim_host/world/traffic/x.cpp", '#include "sim_host/sumo/sumo_traffic.hpp"\n')), 1)
        self.assertEqual(len(findings("sim_host/sumo/x.cpp", '#include "algo/core/math.hpp"\n')), 1)

    # What tells of an ECU knows no process that runs one; a table that let each include the other would have no order.
    def test_folders_do_not_include_each_other(self):
        self.assertEqual(findings("sim_host/processes/x.cpp", '#include "sim_host/telemetry/ecu_tap.hpp"\n'), [])
        self.assertEqual(len(findings("sim_host/telemetry/x.cpp", '#include "sim_host/processes/bus_end.hpp"\n')), 1)
        self.assertEqual(check_includes.circle(check_includes.ALLOWED), [])
        both = {**check_includes.ALLOWED, "sim_host/telemetry/": ["sim_host/processes/"]}
        self.assertEqual(len(check_includes.circle(both)), 1)

    # Planners and what compares them do not include each other: by the registry only, and one way.
    def test_campaign_knows_planners_by_the_registry_only(self):
        self.assertEqual(findings("sim_host/campaign/x.cpp", '#include "sim_host/baselines/planner_registry.hpp"\n'), [])
        self.assertEqual(len(findings("sim_host/campaign/x.cpp", '#include "sim_host/baselines/idm_lane.hpp"\n')), 1)
        self.assertEqual(len(findings("sim_host/baselines/x.cpp", '#include "sim_host/campaign/campaign.hpp"\n')), 1)

    # What opens ticks for a simulated world is no part of a car's ECU.
    def test_ecu_knows_no_lockstep(self):
        self.assertEqual(len(findings("firmware/ecu/x.cpp", '#include "firmware/lockstep/lockstep_bus.hpp"\n')), 1)

    # Firmware has of the core what users of the library have, and nothing else.
    def test_firmware_including_an_internal_header_is_found(self):
        for folder in ("ecu", "targets"):
            self.assertEqual(findings(f"firmware/{folder}/x.cpp", '#include "algo/planner/planner.hpp"\n'), [])
            self.assertEqual(len(findings(f"firmware/{folder}/x.cpp", '#include "algo/core/bounded.hpp"\n')), 1)
            self.assertEqual(len(findings(f"firmware/{folder}/x.cpp", '#include "algo/sadrf/heat_map.hpp"\n')), 1)

    # What is installed: what firmware includes, what that includes in turn, and nothing else.
    def test_list_of_installed_headers_is_held_against_the_code(self):
        self.assertEqual(check_includes.list_findings(check_includes.ROOT), [])
        for listed, found in (("algo/core/a.hpp\n  algo/core/b.hpp\n", []),
                              ("algo/core/a.hpp\n", ["b.hpp: is missing"]),
                              ("algo/core/a.hpp\nalgo/core/b.hpp\n", ["b.hpp: no firmware"]),
                              ("algo/core/a.hpp\n  algo/core/b.hpp\n  algo/core/c.hpp\n", ["c.hpp: no header"])):
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for path, text in (("algo/core/a.hpp", '#include "algo/core/b.hpp"\n'), ("algo/core/b.hpp", ""), ("algo/core/c.hpp", ""),
                                   ("firmware/ecu/x.cpp", '#include "algo/core/a.hpp"\n'), (check_includes.HEADERS, "# One.\n" + listed)):
                    (root / path).parent.mkdir(parents=True, exist_ok=True)
                    (root / path).write_text(text, encoding="utf-8")
                said = check_includes.list_findings(root)
                self.assertEqual(len(said), len(found), said)
                for line, part in zip(said, found):
                    self.assertIn(part, line)


if __name__ == "__main__":
    unittest.main()
