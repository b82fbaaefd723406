// Smoke test of the C++ wrapper, and an example of its use.
//
//     consumer_cpp DRAWING.json OUT.step
//
// makes a solid of the drawing, prints its volume, writes it, and checks that what goes wrong is
// an exception of the right kind. Exits with 0 if all went as the header says.
#include <faceformer.hpp>

#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace ff = faceformer;

static_assert(std::is_nothrow_move_constructible_v<ff::Solid>);
static_assert(!std::is_copy_constructible_v<ff::Drawing>);

namespace {

int failures = 0;

void expect(bool condition, const std::string &what) {
    if (!condition) {
        std::cerr << "not so: " << what << '\n';
        ++failures;
    }
}

template <class Work> void refused(FaceformerStatus status, const char *what, Work &&work) {
    try {
        work();
        expect(false, std::string(what) + " is refused");
    } catch (const ff::Error &error) {
        std::cout << what << ": " << error.what() << '\n';
        expect(error.status() == status, std::string(what) + " has its status");
        expect(error.what() != std::string("no message"), std::string(what) + " has a message");
    }
}

/// The number after a key in JSON text, enough for a test.
double number(const std::string &json, const std::string &key) {
    const auto at = json.find(key);
    return at == std::string::npos ? -1.0 : std::stod(json.substr(at + key.size()));
}

void whole_way(const std::string &json, const std::string &step) {
    std::set<std::string> stages;
    const auto listen = [&stages](std::string_view stage, double share) {
        stages.emplace(stage);
        return share <= 1.0;
    };
    const auto drawing = ff::Drawing::read(json);
    const auto faces = ff::Faces::identify(drawing, R"({"engine": "rotation"})", listen);
    const auto same = ff::Faces::read(drawing, faces.json());
    expect(faces.lift(drawing).find("\"conflicts\":[]") != std::string::npos,
           "right faces do not conflict");
    const auto solid = ff::Solid::build(drawing, same, R"({"flip": true})", listen);
    expect(stages.count("lift") && stages.count("build"), "stages are heard");
    expect(solid.brep().find("CASCADE Topology V1") < 10, "the B-rep is BREP text");
    std::cout << "volume " << number(solid.report(), "\"volume\":") << '\n';
    solid.write(step, "step");
}

void wrong_ways(const std::string &json) {
    refused(FACEFORMER_STATUS_BAD_INPUT, "garbage", [] { ff::Drawing::read("garbage"); });
    const auto drawing = ff::Drawing::read(json);
    const auto faces = ff::Faces::identify(drawing);
    refused(FACEFORMER_STATUS_BAD_INPUT, "faces of nowhere",
            [&] { ff::Faces::read(drawing, R"({"faces": [{"type": "plane", "loops": [[99]]}]})"); });
    refused(FACEFORMER_STATUS_FAILED, "a file that cannot be", [&] {
        ff::Solid::build(drawing, faces).write("no/such/folder/x.step", "step");
    });
    refused(FACEFORMER_STATUS_BAD_INPUT, "unknown options",
            [&] { ff::Solid::build(drawing, faces, R"({"flop": 1})"); });
    refused(FACEFORMER_STATUS_CANCELLED, "cancelling", [&] {
        ff::Faces::identify(drawing, "{}", [](std::string_view, double) { return false; });
    });
    try {
        ff::Solid::build(drawing, faces, "{}", [](std::string_view, double) -> bool {
            throw std::domain_error("from the callback");
        });
        expect(false, "an exception of the callback comes out");
    } catch (const std::domain_error &) {
    }

    // A face is missing: whatever stage finds out, it is a failure, not a crash.
    const auto all = faces.json();
    const auto first = all.find("{\"type\"");
    const auto second = all.find("{\"type\"", first + 1);
    const auto open = ff::Faces::read(drawing, all.substr(0, first) + all.substr(second));
    refused(FACEFORMER_STATUS_FAILED, "an open shell", [&] { ff::Solid::build(drawing, open); });
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::cerr << "usage: consumer_cpp DRAWING.json OUT.step\n";
        return 2;
    }
    std::ifstream file(argv[1], std::ios::binary);
    const std::string json{std::istreambuf_iterator<char>(file), {}};
    try {
        std::cout << "info " << ff::info() << '\n';
        whole_way(json, argv[2]);
        wrong_ways(json);
    } catch (const std::exception &error) {
        expect(false, std::string("no exception: ") + error.what());
    }
    std::cout << failures << " failed\n";
    return failures ? 1 : 0;
}
