// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// @file The part of XML in which robots are described. Private to the project.

namespace excavplan {

constexpr std::size_t most_xml_levels = 64;        ///< of elements in one another; ours
constexpr std::size_t most_xml_elements = 100000;  ///< of a file; ours
constexpr std::size_t most_xml_attributes = 100;   ///< of an element; ours

/// An element with its attributes, their entities replaced, and the elements in it. Texts between
/// elements are not kept.
struct XmlElement {
  std::string name;
  std::size_t line = 0;  ///< of the file, from 1
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;

  /// Null if there is none of that name.
  const std::string* attribute(const std::string& key) const;
  /// The first of that name, or null.
  const XmlElement* child(const std::string& of_name) const;
};

/// Reads one document (XML 1.0). Comments, processing instructions and CDATA are skipped. A
/// document type is refused, and with it all entities but the five of XML itself and numbers of
/// characters.
/// @throws Error (bad_file) naming `name`, the line, what was found and what was expected
XmlElement parse_xml(const std::string& name, const std::string& text);

}  // namespace excavplan
