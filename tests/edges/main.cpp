// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

int main() {}
