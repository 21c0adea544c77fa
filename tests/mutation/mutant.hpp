// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

/// @file
/// Included by every file that has mutations woven in: the environment says which of them is active
/// (EXCAVPLAN_MUTANT), and in which file a byte is set for each that is reached
/// (EXCAVPLAN_MUTANTS_REACHED).

struct ExcavplanMutants {
  static constexpr std::size_t most = 4096;

  ExcavplanMutants() {
    if (const char* number = std::getenv("EXCAVPLAN_MUTANT")) active = std::atoi(number);
    const char* file = std::getenv("EXCAVPLAN_MUTANTS_REACHED");
    if (file == nullptr) return;
    const int opened = ::open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (opened < 0 || ::ftruncate(opened, most) != 0) std::abort();
    void* bytes = ::mmap(nullptr, most, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
    if (bytes == MAP_FAILED) std::abort();
    reached = static_cast<volatile char*>(bytes);
    ::close(opened);
  }

  int active = -1;
  volatile char* reached = nullptr;
};
inline const ExcavplanMutants excavplan_mutants;

inline bool excavplan_mutant(int number) {
  if (excavplan_mutants.reached != nullptr) excavplan_mutants.reached[number] = 1;
  return excavplan_mutants.active == number;
}
