// OCCT writes to the console through a global messenger; a library should not.
#pragma once

#include <Message_Messenger.hxx>
#include <Message_SequenceOfPrinters.hxx>

namespace faceformer::occt {

// Takes the printers out of OCCT's default messenger while it lives, and puts them back. In a
// process that shares its OCCT with us (FreeCAD) the messenger is not ours to change for good.
// One at a time: hold the writer's lock.
class Quiet {
public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet &) = delete;
  Quiet &operator=(const Quiet &) = delete;

private:
  Handle(Message_Messenger) messenger_;
  Message_SequenceOfPrinters printers_;
};

} // namespace faceformer::occt
