// Asio itself, compiled once (ASIO_SEPARATE_COMPILATION); its warnings are not ours
// (CMakeLists.txt).
#include <asio/impl/src.hpp>
