# shellcheck shell=bash
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
#
# Sourced by scripts/test and scripts/demo: ${fast[@]} are the settings of CMake that build fastest from
# nothing, the same with and without a compiler cache, which is used where one is installed.

if command -v ccache >/dev/null; then
  # As its manual asks for precompiled headers.
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
fi
# shellcheck disable=SC2034  # used where this is sourced
fast=(-D EXCAVPLAN_PRECOMPILED=ON)
