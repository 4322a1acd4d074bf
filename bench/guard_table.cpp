// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What Guarded does to frames, what it keeps of its promise, and what it costs. Prints Markdown;
// exits with 1 if a promise is broken or a frame refused. Argument: the letters of the tables, all
// of them unless given.

#include <cstdio>
#include <string>

#include "guard/tables.hpp"

int main(int argc, char** argv) {
    using namespace guard_table;
    const std::string letters = argc > 1 ? argv[1] : "abcdefg";
    bool sound = true;
    for (const char letter : letters) {
        switch (letter) {
            case 'a': sound &= ordinary(); break;
            case 'b': sound &= attacks(); break;
            case 'c': sound &= minutes(); break;
            case 'd': sound &= at_rest(); break;
            case 'e': sound &= damped(); break;
            case 'f': sound &= accuracy(); break;
            case 'g': sound &= stiff_codes(); break;
            default: std::fprintf(stderr, "guard_table: no table %c\n", letter); return 2;
        }
    }
    return sound ? 0 : 1;
}
