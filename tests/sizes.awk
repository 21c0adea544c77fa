# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
#
# Names every function of more than 50 lines, its head included, every room of more than 7,000 lines
# and every folder of more than 40 files, and fails if there is one: awk -f sizes.awk FILES. Relies on
# clang-format: a body is closed by a brace at the indent of the first line of its head.
function indent(text) { match(text, /^ */); return RLENGTH }

function opens_body(text) {
  return text ~ /{$/ && text !~ /\][ (]/ && text !~ /^ *(namespace|struct|class|enum|union|extern) / \
    && text !~ /^ *(}|(if|for|while|switch|else|do|try|catch|case)[ ({])/ \
    && (text ~ /[)]/ || text ~ /^ *:/)
}

# The first line of the head whose last line is `last`.
function head_of(last,    first) {
  first = last
  while (first > 1 && indent(line[first]) > 0 && line[first - 1] !~ /[;{}:]$/ && line[first - 1] != "")
    first--
  return first
}

function measure(file,    i, first, end) {
  for (i = 1; i <= count; i++) {
    if (!opens_body(line[i])) continue
    first = head_of(i)
    if (indent(line[first]) > 4) continue
    for (end = i + 1; end < count; end++)
      if (line[end] ~ /^ *}/ && indent(line[end]) == indent(line[first])) break
    bodies++
    if (end - first + 1 > 50) {
      print file ":" first ": " end - first + 1 " lines, at most 50 are allowed: " line[first]
      failed = 1
    }
  }
}

function too_large(what, size, most, unit) {
  if (size <= most) return
  print what ": " size " " unit ", at most " most " are allowed"
  failed = 1
}

# What a room is of a path: src/<room>, include/excavplan/<room> and tools/<room>.
function room_of(path) {
  sub(/^(.*\/)?(src|include\/excavplan)\//, "", path)
  sub(/^.*\/tools\//, "tools/", path)
  sub(/\/[^\/]*$/, "", path)
  return path
}

FNR == 1 {
  if (NR > 1) measure(file)
  file = FILENAME
  count = 0
  folder = file
  sub(/\/[^\/]*$/, "", folder)
  files[folder]++
}
{
  line[++count] = $0
  lines[room_of(FILENAME)]++
}
END {
  measure(file)
  for (room in lines) too_large(room, lines[room], 7000, "lines")
  for (folder in files) too_large(folder, files[folder], 40, "files")
  if (bodies < 1000) { print "only " bodies " functions were seen: nothing was checked"; failed = 1 }
  exit failed
}
