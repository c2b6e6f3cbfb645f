#include "io/files/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "io/files/files_read.h"

namespace asdic::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".part";
constexpr std::string_view letters = "0123456789abcdefghijklmnopqrstuvwxyz";
constexpr std::size_t mark_length = 4;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string random_mark() {
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, letters.size() - 1);
  std::string mark;
  for (std::size_t i = 0; i < mark_length; ++i) mark += letters[letter(random)];
  return mark;
}

std::string kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::symlink:
      return "a link";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    case fs::file_type::fifo:
      return "a FIFO";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "something that is no file";
  }
}

/// What is written there is on the disk, not on its way to it. \throws RunError
void synchronise(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw RunError(path.string() + ": " + std::strerror(errno));
  const int error = fsync(file) == 0 ? 0 : errno;
  close(file);
  if (error != 0 && error != EINVAL && error != EROFS)  // file systems that know no fsync
    throw RunError(path.string() + ": it cannot be brought to the disk: " + std::strerror(error));
}

void write_all(const fs::path& path, std::string_view bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  int error = file < 0 ? errno : 0;
  while (error == 0 && !bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      error = errno;
  }
  if (file >= 0 && close(file) != 0 && error == 0) error = errno;
  if (error != 0) throw RunError(path.string() + ": " + std::strerror(error));
}

InputError wrong(const OutputRules& rules, const std::string& got, const std::string& expected) {
  return InputError({.where = rules.option, .got = got, .expected = expected});
}

std::string in_quotes(const fs::path& path) { return '"' + path.string() + '"'; }

/// \return whether a file is there \throws InputError for anything else
bool check_place(const fs::path& target, const OutputRules& rules) {
  std::error_code ignored;
  const fs::file_status there = fs::symlink_status(target, ignored);
  if (target.empty() || target.filename().empty() || fs::is_directory(there))
    throw wrong(rules, "the folder " + in_quotes(target), "the name of a file to write");
  if (!fs::is_directory(folder_of(target), ignored))
    throw wrong(rules, "no folder " + in_quotes(target.parent_path()),
                "a file in a folder that is there");
  if (fs::exists(there) && !fs::is_regular_file(there))
    throw wrong(rules, kind_of(there.type()) + ", " + in_quotes(target),
                "the name of a file: asdic replaces nothing else");
  return fs::exists(there);
}

void check_input(const fs::path& target, const OutputRules& rules) {
  constexpr const char* another = "the name of another file to write";
  std::error_code ignored;
  for (const fs::path& input : rules.inputs)
    if (fs::equivalent(target, input, ignored))
      throw wrong(rules, "the input itself, " + in_quotes(target), another);
  if (const auto name = read_before(target))
    throw wrong(rules,
                "the input itself, " + in_quotes(target) +
                    (*name == target ? "" : " (read as " + in_quotes(*name) + ")"),
                another);
}

void check_owner(const fs::path& target, const OutputRules& rules) {
  std::error_code ignored;
  if (rules.force || fs::file_size(target, ignored) == 0) return;
  if (rules.own == nullptr || !rules.own(target))
    throw wrong(rules, in_quotes(target) + ", which asdic did not write",
                "another name, or --force to write over it");
}

}  // namespace

void check_output(const fs::path& target, const OutputRules& rules) {
  if (!check_place(target, rules)) return;
  check_input(target, rules);
  check_owner(target, rules);
}

OutputFile::OutputFile(fs::path target, OutputRules rules)
    : target_((check_output(target, rules), std::move(target))),
      rules_(std::move(rules)),
      lock_(target_) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      rules_(std::move(other.rules_)),
      lock_(std::move(other.lock_)),
      part_(std::exchange(other.part_, fs::path())),
      kept_(other.kept_),
      unfinished_(std::move(other.unfinished_)) {}

OutputFile::~OutputFile() {
  if (part_.empty() || kept_) return;
  std::error_code ignored;
  fs::remove(part_, ignored);
}

const fs::path& OutputFile::part() {
  while (part_.empty()) {
    fs::path name = target_.string() + '.' + random_mark() + std::string(ending);
    unfinished_.emplace(name);  // before the file is there, since a signal may come at any time
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0) {
      const int error = errno;
      unfinished_.reset();
      if (error == EEXIST) continue;
      throw RunError(name.string() + ": " + std::strerror(error));
    }
    close(file);
    part_ = std::move(name);
  }
  return part_;
}

void OutputFile::write(std::string_view bytes) {
  write_all(part(), bytes);
  finish();
}

void OutputFile::finish() {
  const fs::path part = this->part();
  synchronise(part);
  const auto left = [&](const std::string& why) {
    keep();
    return RunError(why + "; the result is in " + part.string());
  };
  try {
    if (check_place(target_, rules_)) {
      if (!rules_.renews) check_input(target_, rules_);
      check_owner(target_, rules_);
    }
  } catch (const InputError& error) {
    throw left(error.what());
  }
  std::error_code error;
  fs::rename(part, target_, error);
  if (error) throw left(target_.string() + ": " + error.message());
  part_.clear();
  unfinished_.reset();
  synchronise(folder_of(target_));
  if (!lock_.alone()) return;  // other runs may be writing a part
  for (const fs::path& old : parts_of(target_))
    if (rules_.worth == nullptr || !rules_.worth(old)) fs::remove(old, error);
}

std::vector<fs::path> parts_of(const fs::path& target) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_of(target), error)) {
    const fs::path path = target.parent_path() / entry.path().filename();
    if (target_of(path) == target) found.push_back(path);
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path target_of(const fs::path& part) {
  const std::string name = part.filename().string();
  const std::size_t more = 1 + mark_length + ending.size();
  if (name.size() <= more || !name.ends_with(ending)) return {};
  const std::size_t dot = name.size() - more;
  const std::string_view mark = std::string_view(name).substr(dot + 1, mark_length);
  if (name[dot] != '.' || mark.find_first_not_of(letters) != std::string_view::npos) return {};
  return part.parent_path() / name.substr(0, dot);
}

}  // namespace asdic::detail
