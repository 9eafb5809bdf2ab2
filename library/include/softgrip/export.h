#pragma once
/// @file
/// Visibility of the public symbols.

/// Marks the symbols that the shared library exports.
#define SOFTGRIP_API __attribute__((visibility("default")))
