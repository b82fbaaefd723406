#include "guard.h"

#include <Standard_Failure.hxx>
#include <Standard_Type.hxx>

namespace faceformer::occt {

std::string describe_current_exception() noexcept {
  try {
    try {
      throw;
    } catch (const Standard_Failure &failure) {
      std::string text = failure.DynamicType()->Name();
      const char *message = failure.GetMessageString();
      if (message != nullptr && *message != '\0') {
        text += ": ";
        text += message;
      }
      return text;
    } catch (const std::exception &failure) {
      return failure.what();
    } catch (...) {
      return "an exception of unknown type";
    }
  } catch (...) {
    // No memory for the words: the empty string needs none.
    return {};
  }
}

} // namespace faceformer::occt
