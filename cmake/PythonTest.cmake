# screwline_add_python_test(NAME FILE): a unittest file that needs no master, as one of the tests that run_tests and ctest know.
function(screwline_add_python_test name file)
  get_filename_component(path ${file} ABSOLUTE)
  set(result ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/python-${name}.xml)
  catkin_run_tests_target(python ${name} python-${name}.xml
    COMMAND "${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/lib/run_unittest ${path} ${result}")
endfunction()
