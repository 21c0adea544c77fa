// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "machine/urdf_tree.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <excavplan/base/error.hpp>

#include "base/read_double.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"

namespace excavplan {
namespace {

using std::string;

constexpr double largest = 1e6;           // of any number [m, rad, kg, ...]; ours
constexpr std::size_t most_links = 1000;  // a machine with its cylinders has some 30; ours

class Parser {
 public:
  Parser(const string& path, const XmlElement& root) : path_(path), root_(root) {}

  UrdfTree tree() {
    if (root_.name != "robot") {
      refuse(root_, "is " + in_quotes(root_.name) + ", expected a URDF, whose element is 'robot'");
    }
    refuse_xacro(root_);
    UrdfTree tree;
    tree.file = path_;
    tree.name = attribute(root_, "name");
    for (const XmlElement& element : root_.children) {
      if (element.name == "link") tree.links.push_back(link(element));
      // Transmissions have a 'joint' too, but as a child of theirs.
      if (element.name == "joint") tree.joints.push_back(joint(element));
    }
    return tree;
  }

 private:
  [[noreturn]] void refuse(const XmlElement& at, const string& what) const {
    throw Error(ErrorKind::bad_file, path_ + ": line " + std::to_string(at.line) + ": " + what);
  }

  void refuse_xacro(const XmlElement& element) const {
    const auto has_macro = [](const auto& attribute) {
      const string& value = attribute.second;
      return attribute.first.rfind("xmlns:", 0) != 0 &&
             (value.find("${") != string::npos || value.find("$(") != string::npos);
    };
    const auto& attributes = element.attributes;
    if (element.name.rfind("xacro:", 0) == 0 ||
        std::any_of(attributes.begin(), attributes.end(), has_macro)) {
      refuse(element, in_quotes(element.name) +
                          " is a macro: this is a xacro, expand it first, with ROS: " + "xacro " +
                          path_ + " > " + expanded());
    }
    for (const XmlElement& child : element.children) refuse_xacro(child);
  }

  /// The name of the file that a xacro becomes.
  string expanded() const {
    std::filesystem::path path = path_;
    if (path.extension() == ".xacro") {
      path.replace_extension();
      return path.string() + (path.extension() == ".urdf" ? "" : ".urdf");
    }
    return path.replace_filename(path.stem().string() + "-plain.urdf").string();
  }

  string attribute(const XmlElement& of, const string& key) const {
    const string* value = of.attribute(key);
    if (!value) refuse(of, in_quotes(of.name) + " has no " + in_quotes(key));
    if (const auto fault = fault_of_line(*value, 200)) {
      refuse(of, key + " of " + in_quotes(of.name) + " is " + *fault);
    }
    return *value;
  }

  /// The child of that name, or null.
  const XmlElement* only(const XmlElement& of, const string& key) const {
    const XmlElement* first = of.child(key);
    for (const XmlElement& each : of.children) {
      if (each.name != key || &each == first) continue;
      const string* name = of.attribute("name");
      refuse(each, of.name + (name ? " " + in_quotes(*name) : "") + " has a second " +
                       in_quotes(key) + ", expected one at most");
    }
    return first;
  }

  /// Numbers with blanks between them.
  std::vector<double> numbers(const XmlElement& of, const string& key) const {
    const string& text = *of.attribute(key);
    std::vector<double> found;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
    for (;; ++at) {
      at = std::find_if_not(at, end, is_blank);
      if (at == end) return found;
      const bool has_plus = *at == '+';
      if (has_plus) ++at;
      double value = 0.0;
      const auto [next, error] = read_double(at, end, value);
      const bool is_number = error == std::errc() && std::abs(value) <= largest &&
                             !(has_plus && *at == '-') && (next == end || is_blank(*next));
      if (!is_number || found.size() == 3) {
        refuse(of, key + " of " + in_quotes(of.name) + " is " + in_quotes(text) +
                       ", expected numbers of at most " + number_text(largest) +
                       " with blanks between them");
      }
      found.push_back(value);
      at = next;
      if (at == end) return found;
    }
  }

  std::optional<double> number(const XmlElement* of, const string& key) const {
    if (!of || !of->attribute(key)) return std::nullopt;
    const auto found = numbers(*of, key);
    if (found.size() != 1) refuse(*of, key + " of " + in_quotes(of->name) + " is not one number");
    return found[0];
  }

  Eigen::Vector3d vector(const XmlElement* of, const string& key,
                         const Eigen::Vector3d& otherwise) const {
    if (!of || !of->attribute(key)) return otherwise;
    const auto found = numbers(*of, key);
    if (found.size() != 3)
      refuse(*of, key + " of " + in_quotes(of->name) + " is not three numbers");
    return {found[0], found[1], found[2]};
  }

  Eigen::Isometry3d pose(const XmlElement* of) const {
    const Eigen::Vector3d rpy = vector(of, "rpy", Eigen::Vector3d::Zero());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() = vector(of, "xyz", Eigen::Vector3d::Zero());
    return pose;
  }

  UrdfLink link(const XmlElement& element) const {
    UrdfLink link;
    link.name = attribute(element, "name");
    if (const XmlElement* inertial = only(element, "inertial")) {
      link.mass = number(only(*inertial, "mass"), "value");
      link.centre = pose(only(*inertial, "origin")).translation();
    }
    return link;
  }

  UrdfJoint joint(const XmlElement& element) const {
    UrdfJoint joint;
    joint.name = attribute(element, "name");
    joint.type = attribute(element, "type");
    joint.line = element.line;
    for (const auto& [key, value] : {std::pair("parent", &joint.parent), {"child", &joint.child}}) {
      const XmlElement* end = only(element, key);
      if (!end) refuse(element, "joint " + in_quotes(joint.name) + " has no " + in_quotes(key));
      *value = attribute(*end, "link");
    }
    joint.origin = pose(only(element, "origin"));
    const Eigen::Vector3d axis = vector(only(element, "axis"), "xyz", Eigen::Vector3d::UnitX());
    if (!(axis.norm() > 1e-6)) {
      refuse(element, "joint " + in_quotes(joint.name) + " has an axis without a direction");
    }
    joint.axis = axis.normalized();
    const XmlElement* limit = only(element, "limit");
    joint.limits = {number(limit, "lower"), number(limit, "upper"), number(limit, "velocity"),
                    number(limit, "effort")};
    joint.mimics = element.child("mimic") != nullptr;
    return joint;
  }

  const string& path_;
  const XmlElement& root_;
};

void require_names(const UrdfTree& tree) {
  if (tree.links.size() > most_links || tree.joints.size() > most_links) {
    throw Error(ErrorKind::bad_file, tree.file + ": found more than " + std::to_string(most_links) +
                                         " links or joints, expected at most that");
  }
  std::set<string> links;
  for (const UrdfLink& link : tree.links) {
    if (links.insert(link.name).second) continue;
    throw Error(ErrorKind::bad_file,
                tree.file + ": link " + in_quotes(link.name) + " appears twice");
  }
  std::set<string> joints;
  for (const UrdfJoint& joint : tree.joints) {
    if (!joints.insert(joint.name).second) tree.refuse(joint, "appears twice");
    for (const string& link : {joint.parent, joint.child}) {
      if (links.count(link) == 0) {
        tree.refuse(joint, "joins link " + in_quotes(link) + ", which the file lacks");
      }
    }
  }
}

/// Each link has one joint above it, and following these leads to the one that has none.
void require_tree(const UrdfTree& tree) {
  std::map<string, const UrdfJoint*> above;
  for (const UrdfJoint& joint : tree.joints) {
    if (above.emplace(joint.child, &joint).second) continue;
    tree.refuse(joint, "is the second that leads to link " + in_quotes(joint.child));
  }
  std::set<string> good;
  string root;
  for (const UrdfLink& link : tree.links) {
    std::set<string> way;
    string at = link.name;
    while (good.count(at) == 0) {
      const auto joint = above.find(at);
      if (!way.insert(at).second) tree.refuse(*joint->second, "is part of a circle");
      if (joint == above.end()) {
        if (!root.empty()) {
          throw Error(ErrorKind::bad_file, tree.file + ": links " + in_quotes(root) + " and " +
                                               in_quotes(at) +
                                               " hang on nothing, expected one root");
        }
        root = at;
        break;
      }
      at = joint->second->parent;
    }
    good.insert(way.begin(), way.end());
  }
  if (root.empty()) throw Error(ErrorKind::bad_file, tree.file + ": it has no link");
}

}  // namespace

const UrdfJoint* UrdfTree::joint(const string& of_name) const {
  const auto found = std::find_if(joints.begin(), joints.end(),
                                  [&](const UrdfJoint& each) { return each.name == of_name; });
  return found == joints.end() ? nullptr : &*found;
}

const UrdfLink* UrdfTree::link(const string& of_name) const {
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&](const UrdfLink& each) { return each.name == of_name; });
  return found == links.end() ? nullptr : &*found;
}

std::vector<const UrdfJoint*> UrdfTree::chain_to(const string& link_name) const {
  std::map<string, const UrdfJoint*> above;
  for (const UrdfJoint& each : joints) above.emplace(each.child, &each);
  std::vector<const UrdfJoint*> chain;
  for (auto at = above.find(link_name); at != above.end(); at = above.find(at->second->parent)) {
    chain.push_back(at->second);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

void UrdfTree::refuse(const UrdfJoint& of, const string& what) const {
  throw Error(ErrorKind::bad_file, file + ": line " + std::to_string(of.line) + ": joint " +
                                       in_quotes(of.name) + " " + what);
}

UrdfTree parse_urdf(const string& path, const string& content) {
  const XmlElement root = parse_xml(path, content);
  UrdfTree tree = Parser(path, root).tree();
  require_names(tree);
  require_tree(tree);
  return tree;
}

}  // namespace excavplan
