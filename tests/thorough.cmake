# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Tests with the label "thorough", which scripts/test leaves out and scripts/check.d/13-thorough runs:
# those that cost most and whose code cheaper tests reach too. By program, as filters of GoogleTest.

# Of these the cases are fewer in scripts/test.
set(label_properties_test properties)

# excavplan_discover_tests(PROGRAM): its tests by name, the thorough ones with their label.
function(excavplan_discover_tests program)
  list(JOIN thorough_${program} ":" filter)
  if(NOT filter)
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${label_${program}}")
    return()
  endif()
  gtest_discover_tests(${program} TEST_FILTER "-${filter}" DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(${program} TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60
    TEST_LIST ${program}_thorough PROPERTIES LABELS thorough)
endfunction()
