# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Figures as PNG and PDF are drawn by cairo, where it is found or unless EXCAVPLAN_WITH_CAIRO is OFF.

option(EXCAVPLAN_WITH_CAIRO "Draw figures as PNG and PDF, where cairo is found" ON)
if(NOT EXCAVPLAN_WITH_CAIRO)
  return()
endif()
find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(cairo QUIET IMPORTED_TARGET cairo fontconfig)
endif()
if(NOT TARGET PkgConfig::cairo)
  message(STATUS
    "without figures as PNG and PDF, which need cairo (pkg-config, libcairo2-dev, libfontconfig-dev)")
  return()
endif()
target_link_libraries(excavplan_figures PRIVATE PkgConfig::cairo)
target_compile_definitions(excavplan_figures PRIVATE EXCAVPLAN_WITH_CAIRO)
set(excavplan_with_cairo TRUE)
