#include "model/document/problem.h"
