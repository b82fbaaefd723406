// C++17 wrapper of faceformer.h: handles free themselves, failures are exceptions.
//
//     auto drawing = faceformer::Drawing::read(json);
//     auto faces = faceformer::Faces::identify(drawing);
//     faceformer::Solid::build(drawing, faces).write("part.step", "step");
//
// Structured data are JSON texts as faceformer.h describes them; read them with the JSON library
// of your choice. The thread rules of faceformer.h hold.
//
// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef FACEFORMER_HPP
#define FACEFORMER_HPP

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "faceformer.h"

namespace faceformer {

/// A call that did not succeed.
class Error : public std::runtime_error {
public:
    Error(FaceformerStatus status, const std::string &message)
        : std::runtime_error(message), status_(status) {}

    /// Why: FACEFORMER_STATUS_FAILED, _BAD_INPUT, _CANCELLED or _PANIC.
    FaceformerStatus status() const noexcept { return status_; }

private:
    FaceformerStatus status_;
};

/// Hears the stage and the share done of it, 0 to 1; returns false to cancel. It may throw: the
/// call then stops, and the exception comes out of it.
using Progress = std::function<bool(std::string_view stage, double share)>;

namespace detail {

template <auto Free> struct Deleter {
    template <class T> void operator()(T *pointer) const noexcept { Free(pointer); }
};
template <class T, auto Free> using Owned = std::unique_ptr<T, Deleter<Free>>;
using Text = Owned<char, faceformer_string_free>;

inline void check(FaceformerStatus status, char *message) {
    Text owned(message);
    if (status != FACEFORMER_STATUS_OK) {
        throw Error(status, owned ? owned.get() : "no message");
    }
}

/// Calls a function whose last argument is the message.
template <class Call> void run(Call &&call) {
    char *message = nullptr;
    const auto status = call(&message);
    check(status, message);
}

/// Calls a function whose last arguments are a string to return and the message.
template <class Call> std::string text(Call &&call) {
    char *result = nullptr;
    char *message = nullptr;
    const auto status = call(&result, &message);
    Text owned(result);
    check(status, message);
    return owned.get();
}

/// Passes a Progress on to C, and holds what it throws until C is off the stack.
class Listener {
public:
    explicit Listener(const Progress &progress) : progress_(progress) {}

    FaceformerProgress callback() const noexcept { return progress_ ? &Listener::call : nullptr; }

    void rethrow() const {
        if (thrown_) {
            std::rethrow_exception(thrown_);
        }
    }

private:
    static std::int32_t call(const char *stage, double share, void *user) noexcept {
        auto *self = static_cast<Listener *>(user);
        try {
            return self->progress_(stage, share) ? 1 : 0;
        } catch (...) {
            self->thrown_ = std::current_exception();
            return 0;
        }
    }

    const Progress &progress_;
    std::exception_ptr thrown_;
};

} // namespace detail

/// What the library is, as JSON: versions, engines, formats.
inline std::string info() {
    return detail::text([](char **json, char **message) { return faceformer_info(json, message); });
}

/// A drawing that was read and checked.
class Drawing {
public:
    /// Reads a drawing in any of the forms of faceformer_drawing_read.
    static Drawing read(std::string_view json) {
        FaceformerDrawing *out = nullptr;
        detail::run([&](char **message) {
            return faceformer_drawing_read(json.data(), json.size(), &out, message);
        });
        return Drawing(out);
    }

    /// The drawing after clean-up and what is wrong with it, as JSON.
    std::string report() const {
        return detail::text([this](char **json, char **message) {
            return faceformer_drawing_report(get(), json, message);
        });
    }

    const FaceformerDrawing *get() const noexcept { return handle_.get(); }

private:
    explicit Drawing(FaceformerDrawing *handle) : handle_(handle) {}

    detail::Owned<FaceformerDrawing, faceformer_drawing_free> handle_;
};

/// Faces of one drawing.
class Faces {
public:
    /// Identifies the faces; options as in faceformer_identify.
    static Faces identify(const Drawing &drawing, std::string_view options = "{}",
                          const Progress &progress = {}) {
        FaceformerFaces *out = nullptr;
        char *message = nullptr;
        detail::Listener listener(progress);
        const auto status =
            faceformer_identify(drawing.get(), options.data(), options.size(), listener.callback(),
                                &listener, &out, &message);
        Faces faces(out);
        detail::Text text(message);
        listener.rethrow();
        detail::check(status, text.release());
        return faces;
    }

    /// Takes faces in the form of json().
    static Faces read(const Drawing &drawing, std::string_view json) {
        FaceformerFaces *out = nullptr;
        detail::run([&](char **message) {
            return faceformer_faces_read(drawing.get(), json.data(), json.size(), &out, message);
        });
        return Faces(out);
    }

    /// Depths, surfaces and conflicts of the faces, as JSON; options as in faceformer_lift.
    std::string lift(const Drawing &drawing, std::string_view options = "{}") const {
        return detail::text([&](char **json, char **message) {
            return faceformer_lift(drawing.get(), get(), options.data(), options.size(), nullptr,
                                   nullptr, json, message);
        });
    }

    /// The faces with types, loops and confidences, as JSON.
    std::string json() const {
        return detail::text([this](char **json, char **message) {
            return faceformer_faces_json(get(), json, message);
        });
    }

    const FaceformerFaces *get() const noexcept { return handle_.get(); }

private:
    explicit Faces(FaceformerFaces *handle) : handle_(handle) {}

    detail::Owned<FaceformerFaces, faceformer_faces_free> handle_;
};

/// A valid closed solid, or the partial shell that a SolidError carries.
class Solid {
public:
    /// Builds the solid; options as in faceformer_solid. Throws SolidError if only a partial shell
    /// could be built.
    static Solid build(const Drawing &drawing, const Faces &faces, std::string_view options = "{}",
                       const Progress &progress = {});

    /// What the solid is and how it came about, as JSON.
    std::string report() const {
        return detail::text([this](char **json, char **message) {
            return faceformer_solid_report(get(), json, message);
        });
    }

    /// The B-rep as OpenCASCADE's BREP text.
    std::string brep() const {
        std::uint8_t *bytes = nullptr;
        std::size_t length = 0;
        detail::run([&](char **message) {
            return faceformer_solid_brep(get(), &bytes, &length, message);
        });
        const auto free = [length](std::uint8_t *b) { faceformer_bytes_free(b, length); };
        const std::unique_ptr<std::uint8_t, decltype(free)> owned(bytes, free);
        return std::string(reinterpret_cast<const char *>(bytes), length);
    }

    /// Writes a file; the format is "step", "brep" or "stl".
    void write(const std::string &path, const std::string &format) const {
        detail::run([&](char **message) {
            return faceformer_solid_write(get(), path.c_str(), format.c_str(), message);
        });
    }

    const FaceformerSolid *get() const noexcept { return handle_.get(); }

private:
    explicit Solid(FaceformerSolid *handle) : handle_(handle) {}

    detail::Owned<FaceformerSolid, faceformer_solid_free> handle_;
};

/// A solid that was not finished, with what could be built of its shell.
class SolidError : public Error {
public:
    SolidError(FaceformerStatus status, const std::string &message, Solid partial)
        : Error(status, message), partial_(std::make_shared<Solid>(std::move(partial))) {}

    /// The partial shell, for inspection.
    const Solid &partial() const noexcept { return *partial_; }

private:
    // Shared, since exceptions are copied.
    std::shared_ptr<const Solid> partial_;
};

inline Solid Solid::build(const Drawing &drawing, const Faces &faces, std::string_view options,
                          const Progress &progress) {
    FaceformerSolid *out = nullptr;
    char *message = nullptr;
    detail::Listener listener(progress);
    const auto status =
        faceformer_solid(drawing.get(), faces.get(), options.data(), options.size(),
                         listener.callback(), &listener, &out, &message);
    Solid solid(out);
    detail::Text text(message);
    listener.rethrow();
    if (status != FACEFORMER_STATUS_OK && out != nullptr) {
        throw SolidError(status, text ? text.get() : "no message", std::move(solid));
    }
    detail::check(status, text.release());
    return solid;
}

} // namespace faceformer

#endif
