// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <report_page.hpp>  // made by examples/report/embed.cmake
#include <string>

#include "findings_json.hpp"

namespace example {

/// The findings as one HTML page that needs nothing else.
inline std::string page(const Findings& found, double d0) {
    Json data;
    data["name"] = found.name;
    data["space"] = found.space;
    data["findings"] = to_json(found, d0);
    data["causes"] = {{"explicit_euler", describe(found.explicit_euler.cause)},
                      {"symplectic_euler", describe(found.symplectic_euler.cause)},
                      {"implicit_euler", describe(found.implicit_euler.cause)}};
    data.update(found.page);
    std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    // Inside a script element only "<" could end it.
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
        text.replace(at, 1, "\\u003c");
    std::string html = report_page;
    const std::string mark = "@DATA@";
    return html.replace(html.find(mark), mark.size(), text);
}

}  // namespace example
