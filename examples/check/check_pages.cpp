// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// check_pages FOLDER: reads every page (*.md) of the repository in FOLDER and names what a reader
// should not meet: what a shell or a compiler says when it fails, paths of the machine that wrote
// the page, cells of a table without a number, links to files and headings that are not there,
// headers and programs of the repository that are called by a path where there is none,
// labels such as [T19] that docs/theory/ does not have or its index does not list, long lines.

#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_line = 118;

struct Page {
    std::vector<std::string> lines;
    std::set<std::string> anchors;
};

/// Characters, not bytes, of UTF-8.
std::size_t length(const std::string& line) {
    std::size_t count = 0;
    for (const char c : line) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    return count;
}

/// The anchor of a heading as GitHub and docs/doxygen_filter.cmake make it.
std::string slug(const std::string& heading) {
    std::string result;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80) continue;
        if (std::isalnum(byte) != 0 || c == '_' || c == '-') result += char(std::tolower(byte));
        if (c == ' ') result += '-';
    }
    return result;
}

bool begins(const std::string& line, const char* start) { return line.rfind(start, 0) == 0; }

Page read_page(const fs::path& path) {
    static const std::regex heading("^#+ +(.*[^ ]) *$");
    Page page;
    std::ifstream file(path);
    std::map<std::string, int> times;
    bool fenced = false;
    for (std::string line; std::getline(file, line);) {
        page.lines.push_back(line);
        if (begins(line, "```")) fenced = !fenced;
        std::smatch found;
        if (fenced || !std::regex_match(line, found, heading)) continue;
        std::string anchor = slug(found[1]);
        const int before = times[anchor]++;
        if (before > 0) anchor += "-" + std::to_string(before);
        page.anchors.insert(anchor);
    }
    return page;
}

class Checker {
public:
    explicit Checker(const fs::path& root) : root_(fs::canonical(root)) {
        for (auto entry = fs::recursive_directory_iterator(root_);
             entry != fs::recursive_directory_iterator(); ++entry) {
            const std::string name = entry->path().filename().string();
            if (entry->is_directory() &&
                (name[0] == '.' || name == "build" || name == "node_modules")) {
                entry.disable_recursion_pending();
            } else if (entry->path().extension() == ".md") {
                pages_[entry->path()] = read_page(entry->path());
            }
        }
    }

    /// @returns the number of faults, each of which it has told
    int check() {
        for (const auto& [path, page] : pages_) find_labels(path, page);
        check_index();
        for (const auto& [path, page] : pages_) check(path, page);
        if (pages_.size() < 10) {
            std::cerr << root_.string() << ": found " << pages_.size() << " pages alone\n";
            ++faults_;
        }
        return faults_;
    }

private:
    void fault(const fs::path& path, std::size_t row, const std::string& what) {
        std::cerr << fs::relative(path, root_).string() << ":" << row + 1 << ": " << what << "\n";
        ++faults_;
    }

    /// A formula of docs/theory/ ends with its label, \textbf{[T19]}.
    void find_labels(const fs::path& path, const Page& page) {
        static const std::regex defined("textbf[{]\\[(T[0-9]+)\\][}]$");
        if (path.parent_path() != root_ / "docs" / "theory") return;
        std::smatch found;
        for (const std::string& line : page.lines)
            if (std::regex_search(line, found, defined))
                labels_[found[1]] = path.filename().string();
    }

    /// docs/theory.md lists each label as a link to the page that has it.
    void check_index() {
        const auto index = pages_.find(root_ / "docs" / "theory.md");
        for (const auto& [label, page] : labels_) {
            const std::string link = "[" + label + "](theory/" + page + "#";
            bool listed = false;
            if (index != pages_.end())
                for (const std::string& line : index->second.lines)
                    listed = listed || line.find(link) != std::string::npos;
            if (!listed) fault(root_ / "docs" / "theory.md", 0, link + "...) is missing");
        }
    }

    void check(const fs::path& path, const Page& page) {
        static const std::regex failure(
            "(^|[^A-Za-z])(Killed|Terminated|Aborted|Segmentation fault|core dumped|command not "
            "found|"
            "No such file or directory|Permission denied|Traceback|FAILED:|terminate called|"
            "(bash|zsh|sh): |ninja: |make(\\[[0-9]+\\])?: [*][*][*])");
        static const std::regex machine("(^|[^A-Za-z0-9_.])/(tmp|work|home|root|Users)/");
        static const std::regex no_number("[|] *[-+]?(nan|NaN|inf|Inf)[ %]*[|]");
        const bool is_changelog = path.filename() == "CHANGELOG.md";
        bool fenced = false;
        for (std::size_t row = 0; row < page.lines.size(); ++row) {
            const std::string& line = page.lines[row];
            std::smatch found;
            if (std::regex_search(line, found, failure)) {
                fault(path, row, "what a program says when it fails: \"" + found[2].str() + "\"");
            }
            if (std::regex_search(line, machine)) fault(path, row, "a path of some machine");
            if (std::regex_search(line, no_number)) fault(path, row, "a cell that is no number");
            check_files(path, row, line);
            if (begins(line, "```")) fenced = !fenced;
            if (fenced || begins(line, "    ")) continue;
            if (!begins(line, "|") && length(line) > longest_line && !is_changelog) {
                fault(path, row,
                      std::to_string(length(line)) + " characters, beyond " +
                          std::to_string(longest_line));
            }
            check_links_and_labels(path, row, line);
            static const std::regex open_bracket("\\[[^\\]]*$");
            static const std::regex closed_below("^[^\\[`]*\\]\\(");
            if (row + 1 < page.lines.size() && std::regex_search(line, open_bracket) &&
                std::regex_search(page.lines[row + 1], closed_below)) {
                fault(path, row,
                      "the text of a link goes over the end of the line, which the site breaks");
            }
        }
        if (fenced) fault(path, page.lines.size() - 1, "the code that ``` begins does not end");
    }

    void check_files(const fs::path& path, std::size_t row, const std::string& line) {
        static const std::regex file(
            "(^|[ `<(])((taut|tests|bench|examples|scripts)/[a-z0-9_/-]+[.](hpp|cpp|cmake|py|sh))");
        for (std::sregex_iterator found(line.begin(), line.end(), file), end; found != end;
             ++found) {
            const std::string name = (*found)[2];
            if (!fs::exists(root_ / (begins(name, "taut/") ? "include" : "") / name)) {
                fault(path, row, name + " does not exist");
            }
        }
    }

    void check_links_and_labels(const fs::path& path, std::size_t row, const std::string& line) {
        static const std::regex code("`[^`]*`");
        static const std::regex link("\\]\\(([^()\\s]+)\\)");
        const std::string words = std::regex_replace(line, code, "`");
        static const std::regex label("\\[(T[0-9]+)\\]");
        for (std::sregex_iterator found(words.begin(), words.end(), label), end; found != end;
             ++found) {
            if (labels_.count((*found)[1]) == 0) {
                fault(path, row, "no page of docs/theory/ has " + found->str());
            }
        }
        for (std::sregex_iterator found(words.begin(), words.end(), link), end; found != end;
             ++found) {
            const std::string target = (*found)[1];
            if (target.find("://") != std::string::npos || begins(target, "mailto:")) continue;
            const auto hash = target.find('#');
            const fs::path file =
                hash == 0 ? path : (path.parent_path() / target.substr(0, hash)).lexically_normal();
            if (!fs::exists(file)) {
                fault(path, row, target + " does not exist");
            } else if (hash != std::string::npos &&
                       (pages_.count(file) == 0 ||
                        pages_[file].anchors.count(target.substr(hash + 1)) == 0)) {
                fault(path, row, target + ": no such heading");
            }
        }
    }

    fs::path root_;
    std::map<fs::path, Page> pages_;
    std::map<std::string, std::string> labels_;  ///< of the theory, each with its page's file
    int faults_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: check_pages FOLDER\n";
        return 2;
    }
    return Checker(arguments[1]).check() == 0 ? 0 : 1;
}
