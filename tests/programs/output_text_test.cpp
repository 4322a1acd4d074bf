// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "../../examples/common/output_text.hpp"
#include "../support/catch.hpp"
#include "../support/temporary_file.hpp"

namespace taut_test::output_text_test {

namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed at the end.
struct Folder {
    Folder() { fs::create_directories(path / "inner"); }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string operator/(const char* name) const { return (path / name).string(); }
    fs::path path = temporary_prefix() + "output_text";
};

void put(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

std::string content(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The complaint about an input and two outputs; empty if there is none.
std::string complaint(const std::string& in, const std::string& a, const std::string& b) {
    try {
        example::require_different({{"IN", in, false}, {"--a", a, true}, {"--b", b, true}});
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("output_text: a file that is written is nobody else's", "[programs]") {
    const Folder folder;
    put(folder / "mesh", "mesh");
    put(folder / "other", "other");
    // Two names that lead to one file, whether it is there or not.
    for (const char* name : {"mesh", "new"}) {
        INFO(name);
        const std::string file = folder / name;
        const std::string same[] = {file, folder / "inner/.." + ("/" + std::string(name)),
                                    (fs::current_path() / file).string()};
        for (const auto& first : same) {
            for (const auto& second : same) {
                CHECK_THAT(complaint(first, second, folder / "c"), ContainsSubstring("--a: "));
                CHECK_THAT(complaint(first, folder / "c", second), ContainsSubstring("--b: "));
                CHECK_THAT(complaint(folder / "c", first, second),
                           ContainsSubstring("is the file of --a too"));
            }
        }
        CHECK(complaint(file, folder / "a", folder / "other") == "");
    }
    CHECK(complaint("", folder / "a", "") == "");
    CHECK(complaint("", "", "") == "");
    CHECK(complaint(folder / "mesh", "-", folder / "a") == "");
    CHECK_THAT(complaint(folder / "mesh", "-", "-"), ContainsSubstring("--b: "));
    // What is only read may be the same.
    CHECK_NOTHROW(
        example::require_different({{"K", folder / "mesh", false}, {"D", folder / "mesh", false}}));
}

TEST_CASE("output_text: text replaces a file's text", "[programs]") {
    const Folder folder;
    example::write_text("new", "--a", folder / "file");
    CHECK(content(folder / "file") == "new\n");
    example::write_text("newer", "--a", folder / "file");
    CHECK(content(folder / "file") == "newer\n");
    CHECK_THROWS_AS(example::write_text("x", "--a", folder / "none/file"), std::runtime_error);
    CHECK_THROWS_AS(example::write_text("x", "--a", folder / "inner"), std::runtime_error);
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 2);  // no draft is left
}

#ifdef __linux__
TEST_CASE("output_text: links are followed and devices shared", "[programs]") {
    const Folder folder;
    put(folder / "mesh", "mesh");
    for (const char* name : {"mesh", "new"}) {
        const std::string link = folder / "inner/link";
        fs::create_symlink(fs::path("..") / name, link);
        CHECK_THAT(complaint(folder / name, link, ""), ContainsSubstring("--a: "));
        example::write_text("through", "--a", link);
        CHECK(content(folder / name) == "through\n");
        CHECK(fs::is_symlink(link));
        fs::remove(link);
    }
    fs::create_hard_link(folder / "mesh", folder / "hard");
    CHECK_THAT(complaint(folder / "mesh", folder / "hard", ""), ContainsSubstring("--a: "));
    CHECK(complaint("/dev/null", "/dev/null", "/dev/null") == "");
    example::write_text("x", "--a", "/dev/null");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("output_text: a file keeps who may read and write it", "[programs]") {
    const Folder folder;
    const std::string file = folder / "file";
    for (const unsigned mode : {0600U, 0640U, 0644U, 0664U, 0666U, 0755U}) {
        put(file, "old");
        fs::permissions(file, fs::perms(mode));
        example::write_text("new", "--a", file);
        CHECK(content(file) == "new\n");
        CHECK(fs::status(file).permissions() == fs::perms(mode));
    }
    fs::permissions(file, fs::perms(0444));
    if (std::ofstream(file, std::ios::app)) return;  // root may write anything
    CHECK_THROWS_AS(example::write_text("x", "--a", file), std::runtime_error);
    CHECK(content(file) == "new\n");
}
#endif

}  // namespace taut_test::output_text_test
