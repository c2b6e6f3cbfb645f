#include "app/lazy_library.h"

#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace asdic::detail::app {
namespace {

[[noreturn]] void give_up(const char* reason) {
  std::fflush(stdout);
  std::fprintf(stderr, "asdic: found no library for this command: %s\n", reason);
  std::exit(1);
}

}  // namespace

void* LazyLibrary::address(const char* name) {
  const std::scoped_lock lock(mutex_);
  if (handle_ == nullptr) handle_ = dlopen(file_, RTLD_LAZY | RTLD_LOCAL);
  void* const found = handle_ == nullptr ? nullptr : dlsym(handle_, name);
  if (found == nullptr) give_up(dlerror());
  return found;
}

int LazyLibrary::initialise(const char* initialiser, std::span<const Variable> variables) {
  const auto own = reinterpret_cast<int (*)()>(address(initialiser));
  const int status = own();
  std::call_once(copied_, [&] {
    for (const Variable& variable : variables)
      std::memcpy(variable.copy, address(variable.name), sizeof(*variable.copy));
  });
  return status;
}

}  // namespace asdic::detail::app

ASDIC_LAZY_HIDDEN void asdic_lazy_find(asdic::detail::app::LazyFunction* function);
void asdic_lazy_find(asdic::detail::app::LazyFunction* function) {
  const auto target = reinterpret_cast<void (*)()>(function->library->address(function->name));
  std::atomic_ref(function->target).store(target, std::memory_order_release);
}

// r11 points to the LazyFunction. The registers that hold arguments (rax: how many of them are of
// floating point) are kept.
asm(R"(
.text
.globl asdic_lazy_first_call
.hidden asdic_lazy_first_call
.type asdic_lazy_first_call, @function
asdic_lazy_first_call:
  push %rax
  push %rdi
  push %rsi
  push %rdx
  push %rcx
  push %r8
  push %r9
  push %r11
  sub $136, %rsp
  movups %xmm0, (%rsp)
  movups %xmm1, 16(%rsp)
  movups %xmm2, 32(%rsp)
  movups %xmm3, 48(%rsp)
  movups %xmm4, 64(%rsp)
  movups %xmm5, 80(%rsp)
  movups %xmm6, 96(%rsp)
  movups %xmm7, 112(%rsp)
  mov %r11, %rdi
  call asdic_lazy_find
  movups (%rsp), %xmm0
  movups 16(%rsp), %xmm1
  movups 32(%rsp), %xmm2
  movups 48(%rsp), %xmm3
  movups 64(%rsp), %xmm4
  movups 80(%rsp), %xmm5
  movups 96(%rsp), %xmm6
  movups 112(%rsp), %xmm7
  add $136, %rsp
  pop %r11
  pop %r9
  pop %r8
  pop %rcx
  pop %rdx
  pop %rsi
  pop %rdi
  pop %rax
  jmp *(%r11)
.size asdic_lazy_first_call, .-asdic_lazy_first_call
)");
