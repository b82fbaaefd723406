// Exceptions at the border: whatever is thrown in C++ becomes an error in Rust.
#pragma once

#include <exception>
#include <string>

namespace faceformer::occt {

// Words for the exception that is being handled: an OCCT Standard_Failure (no std::exception
// before OCCT 8), a std::exception or anything else. Call it in a catch block only.
std::string describe_current_exception() noexcept;

} // namespace faceformer::occt

// cxx calls this around every function of the bridge that returns a Result
// (cxx book, "Result": rust::behavior::trycatch). Its own version knows std::exception only, and
// an OCCT exception would end the process.
namespace rust::behavior {

template <typename Try, typename Fail>
static void trycatch(Try &&func, Fail &&fail) noexcept {
  try {
    func();
  } catch (...) {
    fail(::faceformer::occt::describe_current_exception());
  }
}

} // namespace rust::behavior
