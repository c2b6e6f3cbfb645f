#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/hdf5/handles.h"
#include "io/isolated/pack.h"

// Reading in a child process: questions about a file are calls of Hdf5File's own methods, which the
// child carries out on the file that it has open.
namespace asdic::detail {

template <class Visit>
void fields(DatasetInfo& info, Visit visit) {
  visit(info.path);
  visit(info.type);
  visit(info.shape);
}

}  // namespace asdic::detail

namespace asdic::detail::hdf5 {

template <class T>
inline constexpr std::vector<T> (Hdf5File::*read_all)(const std::string&) const =
    &Hdf5File::read<T>;
template <class T>
inline constexpr std::vector<T> (Hdf5File::*read_block)(const std::string&, const Shape&,
                                                        const Shape&) const = &Hdf5File::read<T>;

/// Methods that can be asked for, each by its number in the list.
template <auto... methods>
struct Questions {
  template <auto method>
  static constexpr std::uint64_t number() {
    std::uint64_t n = 0;
    static_cast<void>(((++n, std::is_same_v<std::integral_constant<decltype(method), method>,
                                            std::integral_constant<decltype(methods), methods>>) ||
                       ...));
    return n;
  }
};

using AllQuestions =
    Questions<&Hdf5File::has, &Hdf5File::datasets, &Hdf5File::info, &Hdf5File::virtual_files,
              &Hdf5File::read_text, &Hdf5File::attributes, &Hdf5File::has_attribute,
              &Hdf5File::attribute_texts, &Hdf5File::attribute_number, &Hdf5File::has_checksums,
              read_all<std::int8_t>, read_all<std::int32_t>, read_all<std::int64_t>,
              read_all<float>, read_all<double>, read_block<std::int8_t>, read_block<std::int32_t>,
              read_block<std::int64_t>, read_block<float>, read_block<double>>;

template <class Method>
struct ResultOf;
template <class R, class... A>
struct ResultOf<R (Hdf5File::*)(A...) const> {
  using Type = R;
};

/// Lets the child call a method. \throws what the method throws, or what Child::ask() does
template <auto method, class... Arguments>
auto ask(isolated::Child& child, const Arguments&... arguments) {
  isolated::Packed question;
  question.put(AllQuestions::number<method>());
  (question.put(arguments), ...);
  const std::string answer = child.ask(question.bytes());
  return isolated::Unpacked(answer).get<typename ResultOf<decltype(method)>::Type>();
}

/// What the child says to such a question about a file that it has open itself.
[[nodiscard]] std::string answer(const Hdf5File& file, std::string_view question);

}  // namespace asdic::detail::hdf5
