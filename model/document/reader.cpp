#include "model/document/reader.h"
