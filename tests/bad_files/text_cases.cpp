// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>

#include "bad_files/bad_file.hpp"
#include "base/json.hpp"
#include "fuzz/file_readers.hpp"

namespace excavplan::test {
namespace {

using nlohmann::ordered_json;
using std::string;

string replaced(string text, const string& from, const string& to) {
  const std::size_t at = text.find(from);
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

/// What spoils any text. Some is YAML, and of some formats others can be cut.
void add_spoiled_text(BadFiles& files, const string& text, bool counted, bool is_yaml = false) {
  const Expected foreign = is_yaml ? either : refused;
  const auto add = [&](const char* name, Expected expected, const string& bytes) {
    files.push_back({name, expected, bytes});
  };
  string wide, wide_big, crlf, cr;
  for (const char c : text) {
    wide += string({c, '\0'});
    wide_big += string({'\0', c});
    crlf += c == '\n' ? "\r\n" : string(1, c);
    cr += c == '\n' ? '\r' : c;
  }
  add("empty", refused, "");
  add("a blank", refused, " ");
  add("a newline", refused, "\n");
  add("a NUL", refused, string(1, '\0'));
  add("UTF-8 byte order mark", either, "\xEF\xBB\xBF" + text);
  add("UTF-16 LE", refused, "\xFF\xFE" + wide);
  add("UTF-16 BE", refused, "\xFE\xFF" + wide_big);
  add("UTF-16 without a mark", refused, wide);
  add("CRLF", same, crlf);
  add("CR", either, cr);
  add("NUL in front", refused, string(1, '\0') + text);
  add("NUL in the middle", refused,
      text.substr(0, text.size() / 2) + '\0' + text.substr(text.size() / 2));
  add("NULs behind", either, text + string(100, '\0'));
  add("half of it", counted ? refused : either, text.substr(0, text.size() / 2));
  add("its second half", counted ? refused : either, text.substr(text.size() / 2));
  add("gzip", refused, "\x1F\x8B\x08" + text);
  add("200 kB of blanks behind", either, text + times(200000, " "));
  add("200 kB of newlines in front", either, times(200000, "\n") + text);
  add("1 MB behind", refused, text + times(1000000, "z"));
  add("HTML", foreign, "<!DOCTYPE html><html></html>\n");
  add("bytes of Latin-1", foreign, "\xFC\xE4\xF6" + text);
  add("a shell script", foreign, "#!/bin/sh\nexit 0\n");
  add("XML", foreign, "<?xml version=\"1.0\"?><x/>\n");
}

// ---- JSON ---------------------------------------------------------------------------------------

/// Closes an object, in formats with a checksum by one.
string closed(const string& format, const string& text) {
  if (!reader_of(format).sealed) return text;
  const std::size_t end = text.find_last_of('}');
  return sealed(end == text.npos ? text
                                 : text.substr(0, text.find_last_not_of(" \n", end - 1) + 1));
}

/// Without its checksum.
string body_of(const string& format, const string& valid) {
  if (!reader_of(format).sealed) return valid;
  return valid.substr(0, valid.size() - sealed("").size()) + "\n}\n";
}

void add_json_values(BadFiles& files, const string& format, const ordered_json& json) {
  const ordered_json flat = json.flatten();
  for (const auto& item : flat.items()) {
    const auto& value = item.value();
    if (!value.is_number()) continue;
    const ordered_json::json_pointer place(item.key());
    const auto add = [&](const string& name, const ordered_json& other) {
      ordered_json changed = json;
      changed[place] = other;
      files.push_back({item.key() + " " + name, either, closed(format, changed.dump(1) + "\n")});
    };
    add("is null", nullptr);
    add("is text", "12");
    add("is a list", {1, 2});
    add("is an object", ordered_json::object());
    add("is -1e308", -1e308);
    add("is 1e308", 1e308);
    add("is 1e-320", 1e-320);
    add("is 0", 0);
  }
}

/// The first number after a key, in place of which other text stands.
string with_number(const string& text, const string& other) {
  constexpr const char* parts = "0123456789.eE+-";
  std::size_t at = text.find_first_of("0123456789", text.find("\": ", text.size() / 2));
  if (at == text.npos) at = text.find_last_of("0123456789");
  at = text.find_last_not_of(parts, at) + 1;
  const std::size_t end = text.find_first_not_of(parts, at);
  return text.substr(0, at) + other + text.substr(end);
}

void add_json_text(BadFiles& files, const string& format, const string& body) {
  const bool is_own = body.find("\"format\"") != body.npos;
  const auto add = [&](const string& name, Expected expected, const string& text) {
    files.push_back({name, expected, closed(format, text)});
  };
  const std::size_t open = body.find('{') + 1;
  const auto with_key = [&](const string& key) {
    return body.substr(0, open) + key + "," + body.substr(open);
  };
  const bool is_lenient = !is_own || format == "entry";
  const Expected unknown = is_lenient ? same : refused;
  add("null", refused, "null");
  add("a list", refused, "[]");
  add("an object without keys", refused, "{}");
  add("a number", refused, "1");
  add("in a list", refused, "[" + body + "]");
  add("a key that is unknown", unknown, with_key("\"unknown_key\": 1"));
  add("a key that is empty", unknown, with_key("\"\": 1"));
  add("a key of 1 MB", unknown, with_key("\"" + times(1000000, "k") + "\": 1"));
  add("50,000 keys", unknown, [&] {
    string keys = "\"a\": 0";
    for (int i = 0; i < 50000; ++i) keys += ",\"k" + std::to_string(i) + "\":0";
    return with_key(keys);
  }());
  add("a list of 200,000", unknown, with_key("\"a\": [0" + times(200000, ",0") + "]"));
  add("60 levels", unknown, with_key("\"a\": " + times(60, "[") + times(60, "]")));
  for (const std::size_t levels : {1000U, 80000U, 400000U}) {
    const string name = std::to_string(levels) + " levels";
    const Expected deep = is_lenient && levels < 10000 ? either : refused;
    add(name + " of lists", deep, with_key("\"a\": " + times(levels, "[") + times(levels, "]")));
    add(name + " of objects", deep,
        with_key("\"a\": " + times(levels, "{\"a\":") + "0" + times(levels, "}")));
    add(name + " left open", refused, times(levels, "["));
  }
  const std::size_t colon = body.find(':');
  const string first_key = body.substr(open, body.find(',') - open);
  add("the first key twice", refused, with_key(first_key));
  add("the first key twice, null", refused,
      body.substr(0, open) + body.substr(open, colon - open) + ": null," + body.substr(open));
  add("a key twice below", refused, with_key("\"a\": {\"b\": 1, \"b\": 2}"));
  for (const char* number : {"NaN", "Infinity", "1e999", "0x10", "+1", "01", "1,5", ".5", "5.",
                             "1_000", "'1'", "--1", "1e", "true1", ""}) {
    const bool is_longer_list = !is_own && number == string("1,5");
    add("a number is " + string(number), is_longer_list ? either : refused,
        with_number(body, number));
  }
  add("a comma at the end", refused, replaced(body, "\n}", ",\n}") + ",");
  add("a comment", refused, "// note\n" + body);
  add("single quotes", refused, replaced(body, "\"", "'"));
  add("no quotes", refused, replaced(replaced(body, "\"", ""), "\"", ""));
  add("bad UTF-8 in a text", refused, with_key("\"name2\": \"\xC3\x28\""));
  add("overlong UTF-8", refused, with_key("\"name2\": \"\xC0\xAF\""));
  add("half a surrogate", refused, with_key("\"name2\": \"\\ud800\""));
  add("a control character in a text", refused, with_key("\"name2\": \"\x1B[31m\""));
  add("an escaped control character", unknown, with_key("\"\\u001b[31m\": 1"));
  add("an escape that is none", refused, with_key("\"name2\": \"\\x41\""));
  add("a text that does not end", refused, with_key("\"name2\": \"..."));
  add("the first key in escapes", same,
      replaced(
          body, first_key.substr(first_key.find('"'), 2), "\"\\u00" + [&] {
            constexpr const char* hex = "0123456789abcdef";
            const auto c = static_cast<unsigned char>(first_key[first_key.find('"') + 1]);
            return string({hex[c >> 4], hex[c & 15]});
          }()));
  add("twice", refused, body + body);
  if (!is_own) return;
  const ordered_json json = ordered_json::parse(body);
  const auto add_with = [&](const string& name, const char* key, const ordered_json& value) {
    ordered_json changed = json;
    changed[key] = value;
    add(name, refused, changed.dump(1) + "\n");
  };
  const int version = json.at("version").get<int>();
  add_with("an older version", "version", version - 1);
  add_with("a newer version", "version", version + 1);
  add_with("version -1", "version", -1);
  add_with("version 1e300", "version", 1e300);
  add_with("half a version", "version", version + 0.5);
  add_with("a version as text", "version", std::to_string(version));
  add_with("another format", "format", "excavplan-else");
  add_with("the format is a number", "format", 1);
  add_with("the format is a list", "format", ordered_json::array());
  const bool others_too = format == "intrinsics";  // have no format
  for (const auto& [key, value] : json.items()) {
    ordered_json changed = json;
    changed.erase(key);
    const bool is_needed = key == "version" || (key == "format" && !others_too);
    files.push_back(
        {"without " + key, is_needed ? refused : either, closed(format, changed.dump(1) + "\n")});
  }
}

}  // namespace

BadFiles bad_json_files(const string& format) {
  BadFiles files;
  for (const string& valid : valid_files(format)) {
    if (valid.find('{') != valid.find_first_not_of(" \n")) continue;
    add_spoiled_text(files, valid, true);
    for (BadFile& file : files) {
      if (file.name == "CRLF" && reader_of(format).sealed) file.expected = refused;
    }
    const string body = body_of(format, valid);
    add_json_text(files, format, body);
    add_json_values(files, format, ordered_json::parse(body));
    if (!reader_of(format).sealed) continue;
    files.push_back({"a byte behind", refused, valid + " "});
    files.push_back({"another checksum", refused, sealed(body)});
    files.push_back({"no checksum", refused, body});
    files.push_back({"a checksum of zeros", refused,
                     valid.substr(0, valid.size() - 21) + "0000000000000000\"\n}\n"});
  }
  return files;
}

// ---- Tables -------------------------------------------------------------------------------------

BadFiles bad_tables(const string& format) {
  BadFiles files;
  const string valid = valid_files(format).front();
  add_spoiled_text(files, valid, false);
  for (BadFile& file : files) {
    if (file.name.rfind("UTF-16", 0) == 0) file.expected = same;
    // Names of its columns count by their letters of ASCII: loggers write others in any encoding.
    if (format == "log" && file.name == "bytes of Latin-1") file.expected = same;
  }
  const std::size_t names_end = valid.find('\n', valid.front() == '#' ? valid.find('\n') + 1 : 0);
  const string names = valid.substr(0, names_end);
  const string rows = valid.substr(names_end + 1);
  const string row = rows.substr(0, rows.find('\n') + 1);
  const string rest = rows.substr(row.size());
  const auto add = [&](const string& name, Expected expected, const string& text) {
    files.push_back({name, expected, text});
  };
  add("no rows", refused, names + "\n");
  add("no names", format == "table" ? either : refused, rows);
  add("a name twice", refused,
      replaced(names, names.substr(names.find_last_of('\n') + 1), "a,a") + "\n1,2\n3,4\n");
  add("a name that is empty", either, names + ",\n" + replaced(row, "\n", ",1\n"));
  for (const char* field : {"", " ", "x", "nan", "inf", "-inf", "1e999", "0x10", "1.5m", "1e",
                            "--1", "1.2.3", "\"", "\"\"", "1;2", "1 2", "=1+1", "\xEF\xBC\x91"}) {
    const string changed = string(field) + row.substr(row.find(','));
    add("a field is '" + string(field) + "'", refused, names + "\n" + changed + rest);
  }
  add("a field too many", refused, names + "\n" + replaced(row, "\n", ",1\n") + rest);
  add("a field missing", refused, names + "\n" + row.substr(row.find(',') + 1) + rest);
  add("a comma at the end", refused, names + "\n" + replaced(row, "\n", ",\n") + rest);
  add("semicolons", same, [&] {
    string text = valid;
    for (char& c : text) c = c == ',' ? ';' : c;
    return text;
  }());
  add("decimal commas", refused, names + "\n\"1,5\"" + row.substr(row.find(',')) + rest);
  add("tabs", same, [&] {
    string text = valid;
    for (char& c : text) c = c == ',' ? '\t' : c;
    return text;
  }());
  add("blank lines", same, names + "\n\n" + row + "\n" + rest + "\n\n");
  add("comments", same, "# a\n" + names + "\n# b\n" + row + rest);
  add("no newline at the end", same, valid.substr(0, valid.size() - 1));
  add("blanks around fields", same, names + "\n " + replaced(row, ",", " , ") + rest);
  add("a row of 200 kB", refused, names + "\n" + times(100000, "1,") + "1\n");
  add("a field of 200 kB", refused, names + "\n" + times(200000, "x") + "\n");
  add("20,000 columns", refused, names + times(20000, ",c") + "\n" + rows);
  add("100,000 rows", either, names + "\n" + times(100000, row));
  add("100,000 blank lines", either, names + "\n" + times(100000, "\n") + rows);
  add("a quote that does not end", either, names + "\n\"" + rows);
  return files;
}

// ---- YAML and frames ----------------------------------------------------------------------------

BadFiles bad_yaml_files(const string& format) {
  BadFiles files;
  for (const string& valid : valid_files(format)) {
    if (valid.find('{') == 0) continue;
    add_spoiled_text(files, valid, format == "frame", format != "frame");
    const auto add = [&](const string& name, Expected expected, const string& text) {
      files.push_back({name, expected, text});
    };
    const Expected wrong = format == "frame" ? refused : either;
    add("twice", refused, valid + valid);
    add("a comment behind", same, valid + "# end\n");
    add("an anchor", refused, "a: &x 1\nb: *x\n" + valid);
    add("many aliases", refused, "a: &a [x,x]\nb: &b [*a,*a]\nc: &c [*b,*b]\nd: [*c,*c]\n");
    add("a merge key", refused, "<<: {a: 1}\nb: &x 2\n" + valid);
    add("a tab as indent", refused, "a:\n\tb: 1\n" + valid);
    add("a block text", refused, "a: |\n  text\n" + valid);
    add("a folded text", refused, "a: >\n  text\n" + valid);
    add("a quote that does not end", refused, "a: \"text\n" + valid);
    add("a bracket that does not end", refused, "a: [1, 2\n" + valid);
    add("a brace that does not end", refused, "a: {b: 1\n" + valid);
    add("a key twice", refused, "a: 1\na: 2\n" + valid);
    add("a flow key twice", refused, "a: {b: 1, b: 2}\n" + valid);
    add("no blank behind a colon", refused, "a:1\nb\n" + valid);
    add("an indent that is wrong", refused, "a:\n    b: 1\n  c: 2\n" + valid);
    add("a list in a map", refused, "a: 1\n- b\n" + valid);
    add("an executable tag", wrong, "a: !!python/object/apply:os.system ['true']\n" + valid);
    add("a document behind", refused, valid + "---\nb: 1\n");
    add("a directive", wrong, "%YAML 9.9\n---\n" + valid);
    for (const std::size_t levels : {100U, 10000U, 200000U}) {
      const string name = std::to_string(levels) + " levels";
      add(name + " of [", refused, "a: " + times(levels, "[") + times(levels, "]") + "\n" + valid);
      add(name + " of {", refused,
          "a: " + times(levels, "{a: ") + times(levels, "}") + "\n" + valid);
      add(name + " left open", refused, times(levels, "["));
      add(name + " of dashes", refused, times(levels, "- ") + "1\n");
    }
    string stairs;
    for (std::size_t i = 0; i < 500; ++i) stairs += string(i, ' ') + "a:\n";
    add("stairs of 500", refused, stairs + valid);
    add("20,000 keys", either, [&] {
      string keys;
      for (int i = 0; i < 20000; ++i) keys += "k" + std::to_string(i) + ": 0\n";
      return keys + valid;
    }());
    add("a line of 300 kB", either, "a: " + times(300000, "x") + "\n" + valid);
    add("a key of 300 kB", either, times(300000, "x") + ": 1\n" + valid);
    add("bad UTF-8", either, "a: \xC3\x28\n" + valid);
  }
  if (format != "frame") return files;
  const string valid = valid_files("frame").front();
  const auto add = [&](const string& name, const string& from, const string& to,
                       Expected expected = refused) {
    files.push_back({name, expected, replaced(valid, from, to)});
  };
  add("15 numbers", "4.25", "");
  add("17 numbers", "4.25", "4.25 1");
  add("a word", "4.25", "four");
  add("NaN", "4.25", "nan");
  add("infinite", "4.25", "inf");
  add("a decimal comma", "4.25", "4,25");
  add("1e400", "4.25", "1e400");
  add("a mirror", "0 -1 0", "0 1 0");
  add("a scale", "0 -1 0", "0 -2 0");
  add("zeros", "0 -1 0", "0 0 0");
  add("the last row", "0 0 0 1", "0 0 0 2");
  add("transposed", "0 0 0 1", "4.25 0 2 1");
  add("far away", "4.25", "1e300", either);
  return files;
}

// ---- Grids --------------------------------------------------------------------------------------

BadFiles bad_grids() {
  BadFiles files;
  const string valid = valid_files("ascii_grid").front();
  add_spoiled_text(files, valid, true);
  const auto add = [&](const string& name, const string& from, const string& to,
                       Expected expected = refused) {
    files.push_back({name, expected, replaced(valid, from, to)});
  };
  for (const char* key : {"ncols", "nrows", "xllcorner", "yllcorner", "cellsize"}) {
    add(string("no ") + key, string(key), "nodata");
    add(string("twice ") + key, "NODATA_value -1", string(key) + " 1");
  }
  for (const char* count : {"0", "-3", "2.5", "1e9", "1e300", "nan", "x", ""}) {
    add("columns " + string(count), "ncols 3", "ncols " + string(count));
    add("cells of " + string(count), "cellsize 0.5", "cellsize " + string(count),
        count == string("2.5") ? either : refused);
  }
  for (const char* value :
       {"inf", "-inf", "1e999", "1e9", "0x10", "1,5", "--1", "1e", "*", "1;2"}) {
    add("a value is " + string(value), "12.5", value);
  }
  add("a value too few", "12.5", "");
  add("a value too many", "12.5", "1 2");
  add("corner and centre", "NODATA_value -1", "xllcenter 1");
  add("far away", "1.5", "1e10");
  add("keys in capitals", "ncols", "NCOLS", same);
  add("on one line", "0.25\n", "0.25 ", same);
  add("a plus", "12.5", "+12.5", same);
  add("more digits", "12.5", "12.50", same);
  add("NODATA is a number", "12.5", "nan", either);
  return files;
}

// ---- Settings -----------------------------------------------------------------------------------

BadFiles bad_settings_files() {
  const string valid = valid_files("settings").front();
  BadFiles files;
  const auto add = [&](const string& name, const string& text, Expected expected = refused) {
    files.push_back({name, expected, text});
  };
  const auto of_tool = [&](const string& name, const string& line, Expected expected = refused) {
    add(name, replaced(valid, "soil = 0.1", line), expected);
  };
  add("empty", "", either);
  add("a NUL", string(1, '\0'));
  add("NUL in the middle", valid.substr(0, 20) + '\0' + valid.substr(20));
  add("UTF-8 byte order mark", "\xEF\xBB\xBF" + valid, same);
  add("UTF-16 LE", "\xFF\xFEs\0o\0");
  add("bytes of Latin-1", valid + "# \xFC\n");
  add("CRLF", replaced(valid, "\n", "\r\n"), same);
  add("CR", replaced(valid, "\n", "\r"));
  add("gzip", "\x1F\x8B\x08" + valid);
  add("HTML", "<!DOCTYPE html><html></html>\n");
  add("JSON", "{\"soil\": \"sand\"}\n");
  add("YAML", "soil: sand\n");
  add("a shell script", "#!/bin/sh\nexit 0\n");
  add("XML", "<?xml version=\"1.0\"?><x/>\n");
  add("1 MB behind", valid + times(1000000, "z"));
  add("2 MB of lines", times(200000, "# comment\n") + valid);
  add("a comment of 2000 bytes", "#" + times(2000, "x") + "\n" + valid);
  add("a comment of 900 bytes", "#" + times(900, "x") + "\n" + valid, same);
  for (const std::size_t levels : {10U, 400U, 499U, 100000U}) {
    const string name = std::to_string(levels) + " levels";
    const Expected short_enough = levels < 500 ? either : refused;
    add(name + " of keys", times(levels, "a.") + "b = 1\n", short_enough);
    add(name + " of tables", "[" + times(levels, "a.") + "b]\n", short_enough);
    add(name + " of lists", "soil = " + times(levels, "[") + times(levels, "]") + "\n");
    add(name + " of tables in line",
        "[plan-path]\nsoil = " + times(levels, "{a=") + "1" + times(levels, "}"));
  }
  of_tool("a key that is no option", "soyl = 1");
  of_tool("a key twice", "soil = 1\nsoil = 2");
  of_tool("a table twice", "soil = 1\n[plan-path]\nsearch = true");
  of_tool("a list of tables", "[[plan-path]]\nsoil = 1");
  of_tool("no value", "soil =");
  of_tool("no key", "= 1");
  of_tool("a word", "soil = sand");
  of_tool("a flag as text", "search = \"yes\"");
  of_tool("a value as flag", "soil = false");
  of_tool("a date", "soil = 2026-02-28");
  of_tool("a date that is none", "soil = 2026-02-30");
  of_tool("a time", "soil = 07:32:00");
  of_tool("a table", "soil = {a = 1}");
  of_tool("a list in a list in a list", "camera = [[[1]]]");
  of_tool("a text that does not end", "soil = \"sand");
  of_tool("a text of several lines", "soil = \"\"\"a\nb\"\"\"");
  of_tool("an escape that is none", "soil = \"\\q\"");
  of_tool("a control character", "soil = \"\\u0007\"");
  of_tool("half a surrogate pair", "soil = \"\\uD800\"");
  of_tool("a number beyond 64 bits", "soil = 99999999999999999999");
  of_tool("1e400", "soil = 1e400", either);
  of_tool("nan", "soil = nan", either);
  of_tool("a leading zero", "soil = 01");
  of_tool("help", "help = true");
  of_tool("config", "config = \"other.toml\"");
  of_tool("a positional", "SCAN = \"x\"");
  add("the tool as a value", "plan-path = 1\n");
  return files;
}

// ---- All ----------------------------------------------------------------------------------------

BadFiles bad_files(const string& format) {
  static const std::set<string> json = {"machine",      "soil",       "law",        "library",
                                        "entry",        "checkpoint", "trajectory", "path_from",
                                        "density_from", "intrinsics", "frame",      "plain_ground"};
  static const std::set<string> tables = {"table", "samples", "log", "known_points"};
  static const std::set<string> yaml = {"yaml", "intrinsics", "frame"};
  BadFiles files;
  const auto add = [&](const BadFiles& more) {
    files.insert(files.end(), more.begin(), more.end());
  };
  if (format == "pcd") add(bad_pcd_files());
  if (format == "ply") add(bad_ply_files());
  if (format == "xyz") add(bad_xyz_files());
  if (format == "las") add(bad_las_files());
  if (json.count(format) != 0) add(bad_json_files(format));
  if (tables.count(format) != 0) add(bad_tables(format));
  if (yaml.count(format) != 0) add(bad_yaml_files(format));
  if (format == "settings") add(bad_settings_files());
  if (format == "ascii_grid") add(bad_grids());
  if (files.empty()) add(bad_binary_files(format));
  add(things_that_are_no_files());
  for (BadFile& file : files) {
    // a search begins anew
    if (format == "checkpoint" && file.make && file.expected == refused) file.expected = either;
  }
  return files;
}

Tolerance tolerance_of(const string& format) {
  static const std::map<string, Tolerance> list = {{"pcd", {Flips::one_line, Cuts::last}},
                                                   {"ply", {Flips::one_line, Cuts::last}},
                                                   {"xyz", {Flips::one_row, Cuts::shorter}},
                                                   {"frame", {Flips::one_line, Cuts::last}},
                                                   {"machine", {Flips::one_leaf, Cuts::none}},
                                                   {"soil", {Flips::one_leaf, Cuts::none}},
                                                   {"law", {Flips::one_leaf, Cuts::none}},
                                                   {"trajectory", {Flips::one_leaf, Cuts::none}},
                                                   {"path_from", {Flips::one_leaf, Cuts::none}},
                                                   {"density_from", {Flips::one_leaf, Cuts::none}},
                                                   {"ground", {Flips::none, Cuts::none}},
                                                   {"ascii_grid", {Flips::any, Cuts::last}},
                                                   {"plain_ground", {Flips::one_leaf, Cuts::none}},
                                                   {"library", {Flips::none, Cuts::none}},
                                                   {"entry", {Flips::none, Cuts::none}},
                                                   {"checkpoint", {Flips::none, Cuts::none}},
                                                   {"depth_png", {Flips::none, Cuts::none}},
                                                   {"las", {Flips::any, Cuts::none}},
                                                   {"bag", {Flips::any, Cuts::none}}};
  const auto found = list.find(format);
  return found == list.end() ? Tolerance{} : found->second;
}

}  // namespace excavplan::test
