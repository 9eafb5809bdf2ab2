# The list of all rooms. A room is a source folder with the rooms whose headers it may include. A room may
# only use rooms that are above it in this file and that it names after USES. If a source includes the header
# of any other room, the build fails (arrows.cmake prints the line and the reason).
# docs/explanation/architecture.md draws the rooms.
#
# Every .cpp file of a room belongs to its library, except the files with main(). A new file needs no edit
# here.

# General functions that every room may use.
softgrip_room(base LIBRARIES Threads::Threads)
target_sources(softgrip_base PRIVATE ${version_file})
add_dependencies(softgrip_base softgrip_version_file)
# Sockets of servers. All servers of the project use this room.
softgrip_room(base/net USES base)
# The results of commands as text, JSON and HTML.
softgrip_room(base/result USES base LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(document USES base LIBRARIES yaml-cpp)

# The model of a finger, and its file format.
softgrip_room(model FOLDERS model/blocks USES base)
softgrip_room(model/file USES base document model)

# The code that is executed in every control cycle.
softgrip_room(control/elements USES base model)
softgrip_room(control/feedforward USES base model control/elements)
softgrip_room(control/tick USES base document model control/elements control/feedforward)
# Computations that are made before the control cycles start: sequences and tuning.
softgrip_room(control/sequences USES base document model control/elements control/feedforward control/tick
  LIBRARIES Eigen3::Eigen)
softgrip_room(control/tuning USES base model control/elements control/feedforward control/tick control/sequences)

# Drivers of the boards.
softgrip_room(drivers/board USES base model)
softgrip_room(drivers/modbus USES base drivers/board LIBRARIES PkgConfig::modbus)
softgrip_room(drivers/modbus_server USES base drivers/modbus)
softgrip_room(drivers/iio USES base drivers/board)
softgrip_room(drivers/gpio USES base model LIBRARIES PkgConfig::gpiod)
if(gpiod_VERSION VERSION_GREATER_EQUAL 2)
  target_compile_definitions(softgrip_drivers_gpio PRIVATE SOFTGRIP_GPIOD_2=1)
endif()

# Simulated and emulated rigs.
softgrip_room(simulation/plant USES base document model drivers/board)
softgrip_room(simulation/emulator
  USES base base/net document model drivers/board drivers/modbus drivers/modbus_server simulation/plant)

# The file format of softgrip-plc. `softgrip check` also reads it.
softgrip_room(rig/plc_file USES base base/net document LIBRARIES fmt::fmt)
# The file format of softgrip-web. `softgrip check` also reads it.
softgrip_room(rig/web_file USES base base/net document)

# The file format of the rig.
softgrip_room(rig
  USES base document model/file control/feedforward control/tick control/sequences drivers/board drivers/modbus
       drivers/iio drivers/gpio simulation/plant rig/plc_file rig/web_file)

# The daemon softgripd.
softgrip_room(daemon/loop USES base model control/elements control/tick drivers/board rig LIBRARIES spdlog::spdlog)
softgrip_room(daemon/recording
  USES base control/elements control/tick rig daemon/loop
  LIBRARIES spdlog::spdlog nlohmann_json::nlohmann_json)
softgrip_room(daemon/panel USES base drivers/gpio rig daemon/loop)
softgrip_room(daemon/socket
  USES base base/net document model control/elements control/tick control/sequences rig daemon/loop daemon/recording
  LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(daemon/service
  USES base base/net control/tick drivers/board drivers/iio drivers/gpio rig daemon/loop daemon/recording daemon/panel daemon/socket
  LIBRARIES spdlog::spdlog nlohmann_json::nlohmann_json PkgConfig::systemd)

# System identification: from logs to a model and to the cause of its error.
# The limits of all decisions. This room is a single header.
softgrip_room(sysid/limits)
softgrip_room(sysid/logs USES base document model sysid/limits)
softgrip_room(sysid/recordings USES base document sysid/logs LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(sysid/import USES base document model sysid/logs LIBRARIES nlohmann_json::nlohmann_json)
# These libraries are linked PRIVATE, so other rooms are not compiled with their headers.
target_link_libraries(${softgrip_room_target} PRIVATE ZLIB::ZLIB PkgConfig::matio PkgConfig::hdf5 PkgConfig::libzip PkgConfig::pugixml)
softgrip_room(sysid/pages USES base base/result model model/file sysid/logs)
softgrip_room(sysid/fitting USES base model sysid/limits sysid/logs LIBRARIES Eigen3::Eigen)
softgrip_room(sysid/identification
  USES base base/result document model model/file sysid/limits sysid/logs sysid/pages sysid/fitting
  LIBRARIES Eigen3::Eigen nlohmann_json::nlohmann_json)
softgrip_room(sysid/evidence USES base sysid/limits sysid/logs sysid/fitting)
softgrip_room(sysid/structure
  USES base model sysid/limits sysid/logs sysid/fitting sysid/identification sysid/evidence
  LIBRARIES Eigen3::Eigen)
softgrip_room(sysid/diagnosis/residual USES base sysid/limits sysid/logs LIBRARIES Eigen3::Eigen)
softgrip_room(sysid/instrument
  USES base model sysid/logs sysid/pages sysid/fitting sysid/identification sysid/structure sysid/diagnosis/residual)
softgrip_room(sysid/diagnosis/causes
  USES model sysid/logs sysid/fitting sysid/evidence sysid/diagnosis/residual)
softgrip_room(sysid/diagnosis/search
  USES base model sysid/limits sysid/logs sysid/fitting sysid/identification sysid/evidence sysid/diagnosis/residual
       sysid/diagnosis/causes)
softgrip_room(sysid/diagnosis/evidence
  USES base model sysid/limits sysid/logs sysid/fitting sysid/identification sysid/diagnosis/search)
softgrip_room(sysid/diagnosis/gauge
  USES base document model sysid/limits sysid/logs sysid/fitting sysid/diagnosis/residual sysid/diagnosis/causes
       sysid/diagnosis/search)
softgrip_room(sysid/diagnosis/verdict
  USES base model sysid/limits sysid/logs sysid/fitting sysid/identification sysid/structure sysid/diagnosis/residual sysid/diagnosis/causes
       sysid/diagnosis/search sysid/diagnosis/evidence sysid/diagnosis/gauge sysid/evidence
  LIBRARIES Eigen3::Eigen)
softgrip_room(sysid/changes
  USES base base/result model sysid/limits sysid/logs sysid/pages sysid/fitting sysid/structure sysid/evidence sysid/diagnosis/residual
       sysid/diagnosis/causes
  LIBRARIES Eigen3::Eigen nlohmann_json::nlohmann_json)
softgrip_room(sysid/diagnosis/experiments
  USES base base/result sysid/limits sysid/logs sysid/fitting sysid/identification sysid/diagnosis/residual
       sysid/diagnosis/causes sysid/diagnosis/search sysid/diagnosis/gauge sysid/diagnosis/verdict)
softgrip_room(sysid/diagnosis/report
  USES base base/result model model/file sysid/logs sysid/pages sysid/fitting sysid/identification sysid/diagnosis/causes
       sysid/diagnosis/evidence sysid/diagnosis/gauge sysid/diagnosis/verdict sysid/diagnosis/experiments)
# Health analysis: recorded grips become indicators and their charts, and changed indicators become alarms.
softgrip_room(sysid/health
  USES base base/result document model model/file control/elements sysid/limits sysid/logs sysid/recordings sysid/pages sysid/fitting sysid/diagnosis/causes
       sysid/changes sysid/diagnosis/experiments
  LIBRARIES Eigen3::Eigen nlohmann_json::nlohmann_json)
# These files contain the innermost loops of a fit, so they are compiled with -O3. GCC 12 fails if -O3 is combined with
# a sanitizer.
if(NOT SOFTGRIP_SANITIZE)
  softgrip_flags_of(sysid/fitting -O3 chain_residuals.cpp separable.cpp separable_pressure.cpp separable_search.cpp)
endif()

# The programs.
softgrip_room(tools/command_line USES base document model model/file LIBRARIES CLI11::CLI11)
target_compile_definitions(${softgrip_room_target} PRIVATE SOFTGRIP_CONFIG_DIR="${SOFTGRIP_CONFIGURATION}")
softgrip_room(tools/client USES base base/net document control/tick control/elements rig tools/command_line LIBRARIES nlohmann_json::nlohmann_json)
# Gateways: separate processes between the daemon's socket and a network.
softgrip_room(tools/plc USES base base/net control/elements drivers/modbus_server rig/plc_file tools/client
  LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(tools/web/metrics USES base LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(tools/web/access USES base base/net rig/web_file LIBRARIES fmt::fmt)
softgrip_room(tools/web FOLDERS tools/web/page
  USES base base/net rig/web_file tools/client tools/web/metrics tools/web/access
  LIBRARIES nlohmann_json::nlohmann_json fmt::fmt PkgConfig::httplib)
softgrip_page_files(tools/web/page)
if(httplib_VERSION VERSION_GREATER_EQUAL 0.18)
  target_compile_definitions(${softgrip_room_target} PRIVATE SOFTGRIP_HTTPLIB_ADDRESSES=1)
endif()
# This room is separate from tools/command_line. A network can reach the gateways, so they must not link the readers of
# external files.
softgrip_room(tools/log_input USES base document model sysid/logs sysid/import sysid/diagnosis/gauge tools/command_line
  LIBRARIES CLI11::CLI11)
softgrip_room(tools/recordings USES base sysid/logs sysid/recordings sysid/pages)
# This room has precompiled headers of its own. librsvg needs -pthread, but the precompiled headers that the other rooms
# share are compiled without it.
softgrip_room(tools/figures USES base sysid/pages PRECOMPILE <string> <vector>)
target_link_libraries(${softgrip_room_target} PRIVATE PkgConfig::librsvg)
softgrip_room(tools/importing USES base document sysid/logs sysid/import tools/command_line
  LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(tools/exporting
  USES base document model model/file control/elements control/feedforward sysid/logs sysid/recordings sysid/import
       tools/command_line tools/log_input
  LIBRARIES nlohmann_json::nlohmann_json)
target_link_libraries(${softgrip_room_target} PRIVATE ZLIB::ZLIB PkgConfig::matio)
# Commands that move a rig without the daemon: doctor and calibrate.
softgrip_room(tools/commissioning
  USES base base/net base/result document model model/file control/elements control/feedforward drivers/board drivers/modbus rig/plc_file
       rig/web_file rig daemon/loop daemon/recording tools/command_line
  LIBRARIES nlohmann_json::nlohmann_json)
softgrip_room(tools/investigation
  USES base base/result document model model/file control/elements control/feedforward control/tuning simulation/plant rig
       daemon/service daemon/socket sysid/logs sysid/recordings sysid/pages sysid/identification sysid/diagnosis/causes
       sysid/diagnosis/verdict sysid/diagnosis/experiments sysid/diagnosis/report
  LIBRARIES nlohmann_json::nlohmann_json)
# Computes the values of a report independently, to verify the report.
softgrip_room(tools/verification USES base document model model/file sysid/logs sysid/changes LIBRARIES nlohmann_json::nlohmann_json)
# Studies of the paper, which `softgrip study` runs.
softgrip_room(bench/studies
  USES base base/result model control/elements control/feedforward control/tuning sysid/logs sysid/pages sysid/fitting
       sysid/identification)
# Runs the commissioning experiment on a rig.
softgrip_room(tools/baseline
  USES base daemon/service sysid/logs sysid/identification sysid/diagnosis/experiments tools/investigation)
softgrip_room(tools/commands
  USES base base/result model/file control/feedforward control/tuning rig daemon/service daemon/socket sysid/logs sysid/recordings
       sysid/pages sysid/fitting sysid/identification sysid/structure sysid/instrument sysid/changes sysid/diagnosis/verdict
       sysid/diagnosis/report sysid/health tools/command_line tools/client
       tools/log_input tools/recordings tools/figures tools/importing tools/exporting tools/commissioning tools/investigation tools/verification
       tools/baseline bench/studies
  LIBRARIES CLI11::CLI11 nlohmann_json::nlohmann_json
  PRECOMPILE <CLI/CLI.hpp>)

# The public library. No other room uses it.
softgrip_room(library FOLDERS library/include/softgrip
  USES base base/result document model model/file control/elements control/feedforward control/tick drivers/board simulation/plant
       sysid/logs sysid/import sysid/fitting sysid/identification sysid/instrument sysid/diagnosis/report
       sysid/diagnosis/verdict sysid/changes sysid/health
  LIBRARIES nlohmann_json::nlohmann_json)
softgrip_public_headers(library/include)

softgrip_program(softgripd daemon/service/softgripd.cpp daemon ROOM daemon/service LIBRARIES CLI11::CLI11)
softgrip_program(softgrip tools/programs/softgrip.cpp tools ROOM tools/commands)
softgrip_program(softgrip-rig "tools/programs/softgrip_rig.cpp;tools/programs/softgrip_rig_options.cpp" tools
  ROOM simulation/emulator USES base base/net document model model/file drivers/board drivers/modbus drivers/modbus_server
       simulation/plant simulation/emulator rig tools/command_line
  LIBRARIES CLI11::CLI11)
softgrip_program(softgrip-plc tools/programs/softgrip_plc.cpp tools
  ROOM tools/plc USES base base/net drivers/modbus_server rig/plc_file tools/command_line
  LIBRARIES CLI11::CLI11)
softgrip_program(softgrip-web tools/programs/softgrip_web.cpp tools
  ROOM tools/web USES base base/net rig/web_file tools/command_line
  LIBRARIES CLI11::CLI11)
