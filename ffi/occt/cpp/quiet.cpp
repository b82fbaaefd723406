#include "quiet.h"

#include <Message.hxx>

namespace faceformer::occt {

Quiet::Quiet() : messenger_(Message::DefaultMessenger()), printers_(messenger_->Printers()) {
  messenger_->ChangePrinters().Clear();
}

Quiet::~Quiet() { messenger_->ChangePrinters() = printers_; }

} // namespace faceformer::occt
