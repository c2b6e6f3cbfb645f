#pragma once
#include <cstdint>
#include <mutex>
#include <span>

// Shared libraries that are loaded when the first of their functions is called. HDF5 and netCDF
// bring sixty others with them (by libcurl), which take longer to load than `asdic bellhop` works.
// cmake/LazyStubs.cmake writes a source file of the macros below: a function each that the program
// calls, under its own name, which jumps to the one of the library. x86-64 alone.
namespace asdic::detail::app {

/// A shared library. `constinit`: functions may be called while other files' globals are made.
class LazyLibrary {
 public:
  /// \param file  its name for the dynamic linker: "libhdf5_serial.so.103"
  constexpr explicit LazyLibrary(const char* file) : file_(file) {}

  /// Loads the library if need be. Without it, or without the function, the program says so and
  /// ends with status 1: what calls a C function expects no exception.
  [[nodiscard]] void* address(const char* name);

  /// A number that the library sets when it is initialised (the ids of HDF5's types), as the
  /// program sees it.
  struct Variable {
    const char* name;
    std::int64_t* copy;
  };
  /// Calls the library's own initialiser, then copies its variables, once. \return what the
  /// initialiser returned
  int initialise(const char* initialiser, std::span<const Variable> variables);

 private:
  const char* file_;
  std::mutex mutex_;
  void* handle_ = nullptr;
  std::once_flag copied_;
};

/// Where a function is: at first the code that looks for it. Known to the assembler below by its
/// layout.
struct LazyFunction {
  void (*target)();
  const char* name;
  LazyLibrary* library;
};

}  // namespace asdic::detail::app

#define ASDIC_LAZY_HIDDEN extern "C" __attribute__((visibility("hidden")))

/// Finds the function, then goes on into it with all arguments as they were.
ASDIC_LAZY_HIDDEN void asdic_lazy_first_call();

#define ASDIC_LAZY_FUNCTION(lazy_library, function)                                             \
  ASDIC_LAZY_HIDDEN void asdic_first_##function();                                              \
  ASDIC_LAZY_HIDDEN asdic::detail::app::LazyFunction asdic_lazy_##function;                     \
  constinit asdic::detail::app::LazyFunction asdic_lazy_##function{asdic_first_##function,      \
                                                                   #function, &(lazy_library)}; \
  asm(".text\n.globl " #function "\n.hidden " #function "\n.type " #function                    \
      ", @function\n" #function ":\n  jmp *asdic_lazy_" #function "(%rip)\n.size " #function    \
      ", .-" #function "\n.globl asdic_first_" #function "\n.hidden asdic_first_" #function     \
      "\n.type asdic_first_" #function ", @function\nasdic_first_" #function                    \
      ":\n  lea asdic_lazy_" #function                                                          \
      "(%rip), %r11\n  jmp asdic_lazy_first_call\n.size "                                       \
      "asdic_first_" #function ", .-asdic_first_" #function "\n");

#define ASDIC_LAZY_VARIABLE(variable)      \
  ASDIC_LAZY_HIDDEN std::int64_t variable; \
  std::int64_t variable = 0;

#define ASDIC_LAZY_INITIALISER(lazy_library, function, variables) \
  ASDIC_LAZY_HIDDEN int function();                               \
  int function() { return (lazy_library).initialise(#function, variables); }
