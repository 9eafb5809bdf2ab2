#pragma once
/// @file
/// Includes all public headers of the library.

#include <softgrip/board.h>     // IWYU pragma: export
#include <softgrip/control.h>   // IWYU pragma: export
#include <softgrip/diagnose.h>  // IWYU pragma: export
#include <softgrip/error.h>     // IWYU pragma: export
#include <softgrip/health.h>    // IWYU pragma: export
#include <softgrip/identify.h>  // IWYU pragma: export
#include <softgrip/log.h>       // IWYU pragma: export
#include <softgrip/model.h>     // IWYU pragma: export
#include <softgrip/validate.h>  // IWYU pragma: export
#include <softgrip/version.h>   // IWYU pragma: export
