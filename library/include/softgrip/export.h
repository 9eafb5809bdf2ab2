#pragma once
/// @file
/// Visibility of the public symbols.

/// Marks what the shared library exports.
#define SOFTGRIP_API __attribute__((visibility("default")))
