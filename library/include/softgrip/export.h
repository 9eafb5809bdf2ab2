#pragma once
/// @file
/// Determines which symbols the shared library exports.

/// Marks the symbols that the shared library exports.
#define SOFTGRIP_API __attribute__((visibility("default")))
