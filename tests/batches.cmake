# Tests of a folder that are compiled together, a batch a line: half the work, as what they include and instantiate is
# there once. No two tests of a batch name something alike in their anonymous namespaces; a test in none is compiled alone.
set(unit_batches
  "attribution bicycle box branch bus_end bus_name clips clusters codec"
  "candidates candidates_lateral_offset running_plan guard guard_change guard_licence lane_cost_to_go lane_reach legal_occupancy"
  "candump command_check core drf_controller drivable e2e ecu_exchange ecu_inputs ecu_process"
  "encounters fail_safe families fault_judge fault_judge_stop fault_script faulty_bus field figures"
  "foreign_networks gate gate_denial hal_sim heat_map idm_lane ilqr inconsistent_map input_link key_file"
  "lane_gap lane_map lane_path lateral_offset law live_view lockstep_bus log_follower"
  "map_node math meetings metrics mission_check modes network_input optimizer"
  "network_operators network pace parameters_file parameters perception plan_words planner_registry"
  "planner_input planner polyline predictive_decision predictor presets processes record_limits safe_distance"
  "plausibility plausibility_clock realtime records results rough_tracks route_file self_test"
  "replay route_guide s4tp_c s4tp_c_invalid s4tp_c_values sample_file satp_network satp_predictor scenario standing"
  "scene_builder scene_tracks secoc_can secoc_lists secoc_map secoc_map_stranger secoc_restarts secoc_session shared_records slcan threshold"
  "scoring tight_corner"
  "risk risk_work"
  "constant_margin slcan_can social_value static_drf summary sumo_routes toml_shape traci track_list traffic_statistics"
  "socket_can socket_pair tracker tracker_stop traffic_driver utf8 vehicle_clock vehicle_node vehicle weight_image"
  "network_limits traffic_junction world yield_belief")
set(property_batches
  "candump_property codec_property collision_property cost_map decision_property ecu_frames polyline_property scenario_files_property"
  "field_slices gate_property map_receiver_property refinement_property risk_properties safe_distance_property wire_lists_property"
  "guard_property motion_property plan_property"
  "refinement_field scene_property slcan_property")
set(integration_batches
  "allowance authentic_drive baselines board_twin closed_loop data_drive ecu_cycle ecu_parameters ecu_reports empty_roads"
  "authentic_processes two_processes"
  "blind_leader campaign ecu_faults ecu_modes fault_campaign map_on_the_wire plan_words_drives threads traffic"
  "ecu_lies ecu_minimum_risk lies target_loop"
  "sumo_driver sumo_process sumo_traffic")

# s4tp_test_batches(TARGET FOLDER)
function(s4tp_test_batches target folder)
  set(number 0)
  foreach(batch IN LISTS ${folder}_batches)
    separate_arguments(sources UNIX_COMMAND "${batch}")
    list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/)
    list(TRANSFORM sources APPEND _test.cpp)
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${folder}_${number})
    math(EXPR number "${number} + 1")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
