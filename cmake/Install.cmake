# Everything a user needs from the install space. Who adds a library, a node, a tool or a script adds its name here.
set(libraries screwline_core screwline_ros)
set(executables frame_broadcaster kinematics_server recorder trajectory_generator)
set(python_scripts scripts/report scripts/scenario)
set(folders launch urdf config)

install(TARGETS ${libraries}
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
install(TARGETS ${executables} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
catkin_install_python(PROGRAMS ${python_scripts} DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY include/screwline/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(DIRECTORY ${folders} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
# What scripts/report and scripts/scenario are made of, and the table that a scenario compares with.
install(DIRECTORY scripts/screwline_report scripts/screwline_scenario DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} PATTERN __pycache__ EXCLUDE)
install(FILES test/data/rrp_tool_velocity.csv DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/test/data)
