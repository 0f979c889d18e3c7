# Unity builds (preset release) compile eight sources of a target as one, because most of a source's time goes into its headers.
# These sources are compiled alone: names local to them equal names local to a neighbour. To shorten the list, rename them.
function(tubecut_alone target folder)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

tubecut_alone(tubecut_core core/bevel/beam beam.cpp beam_axes.cpp beam_lanes.cpp drop_lanes.cpp torch_line.cpp)
tubecut_alone(tubecut_core core/bevel/smoothing programme.cpp)
tubecut_alone(tubecut_core core/frame alike.cpp alike_form.cpp)
tubecut_alone(tubecut_core core/joint contour.cpp event_phases.cpp intersection.cpp length.cpp)
tubecut_alone(tubecut_core core/joint/node node.cpp node_connect.cpp overlap.cpp shared_metal.cpp)
tubecut_alone(tubecut_core core/joint/cutters elbow.cpp elbow_solid.cpp rectangular_tube.cpp tube.cpp)
tubecut_alone(tubecut_core core/part member.cpp)
tubecut_alone(tubecut_api api batch.cpp suspicion.cpp version.cpp)  # version is replaced by a server of the tests
tubecut_alone(tubecut_api api/catalog post_units.cpp tube_sizes.cpp)
tubecut_alone(tubecut_api api/wire cbor.cpp json.cpp reader.cpp)  # the fuzz run instruments them
tubecut_alone(tubecut_api api/endpoints bevel_tables.cpp holes.cpp joint_codec.cpp part_request.cpp)
tubecut_alone(tubecut_api api/endpoints/frames frame_request.cpp node_codec.cpp)
tubecut_alone(tubecut_api api/endpoints/motion feed_curves.cpp)
file(GLOB_RECURSE FORMATS RELATIVE ${PROJECT_SOURCE_DIR}/api/formats CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/api/formats/*.cpp)
tubecut_alone(tubecut_api api/formats ${FORMATS})
# gcc counts a class with members of a source's own types as such in the source itself, but not in a unit.
set_target_properties(tubecut_server PROPERTIES UNITY_BUILD OFF)
if(TUBECUT_TESTS)
  tubecut_alone(core_joint_test tests/core/joint degenerate_test.cpp elbow_leg_test.cpp ray_test.cpp shared_metal_test.cpp)
  tubecut_alone(core_bevel_test tests/core/bevel between_rows_test.cpp elbow_table_test.cpp envelope_test.cpp hole_test.cpp radius_rates_test.cpp)
  tubecut_alone(core_groove_test tests/core/groove groove_test.cpp)
  tubecut_alone(core_part_test tests/core/part dimensions_test.cpp)
  tubecut_alone(core_part_test tests/core/torch program_schedule_test.cpp)
  set_target_properties(core_motion_test api_endpoints_test api_formats_test api_members_test server_app_test PROPERTIES UNITY_BUILD OFF)
endif()
