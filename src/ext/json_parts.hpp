// SPDX-License-Identifier: MIT
//
// What json.cpp and json_text.cpp know of a document.
#ifndef NT_EXT_JSON_PARTS_HPP
#define NT_EXT_JSON_PARTS_HPP

#include "ext/json.h"

#include <nlohmann/json.hpp>

struct nt_json {
	nlohmann::ordered_json root = nlohmann::ordered_json::object();
	nlohmann::ordered_json scratch; // what changing functions hand out once memory is exhausted
	int indent = -1;
	char indent_character = ' ';
	bool failed = false;
};

#endif
