#include "model/document/node.h"
