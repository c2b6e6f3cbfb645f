#include "io/hdf5/remote.h"

#include <stdexcept>
#include <tuple>

namespace asdic::detail::hdf5 {
namespace {

template <class R, class... A>
void call(const Hdf5File& file, R (Hdf5File::*method)(A...) const, isolated::Unpacked& question,
          isolated::Packed& answer) {
  const std::tuple<std::decay_t<A>...> arguments{question.get<std::decay_t<A>>()...};  // in order
  answer.put(std::apply([&](const auto&... each) { return (file.*method)(each...); }, arguments));
}

template <auto... methods>
std::string answer(Questions<methods...>, const Hdf5File& file, std::string_view question) {
  isolated::Unpacked in(question);
  const auto number = in.get<std::uint64_t>();
  isolated::Packed out;
  std::uint64_t n = 0;
  const bool known = ((++n == number && (call(file, methods, in, out), true)) || ...);
  if (!known) throw std::logic_error("a question about an HDF5 file that nobody answers");
  return out.bytes();
}

}  // namespace

std::string answer(const Hdf5File& file, std::string_view question) {
  return answer(AllQuestions{}, file, question);
}

}  // namespace asdic::detail::hdf5
