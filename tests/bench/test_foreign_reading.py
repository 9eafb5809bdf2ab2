"""Tests bench/foreign/log_reading.py with valid and broken logs in formats of other programs."""
import math

from foreign_case import SAMPLES, ForeignCase, kpa, log_text, mm

PLAIN = "time: t_s\ncommand: u_kpa\ndisplacement: y_mm\n"


class Forms(ForeignCase):
    def test_a_unit_is_read_from_the_column_name(self):
        self.put_plain()
        self.assert_log(self.read(PLAIN))

    def test_units_in_brackets_are_read_and_converted(self):
        self.put(log_text("Time [ms],Supply (bar),Tip (cm)",
                          lambda i: f"{100 * i + 5000},{kpa(i) / 100:.8f},{mm(i) / 10:.8f}"))
        self.assert_log(self.read("time: Time [ms]\ncommand: Supply (bar)\ndisplacement: Tip (cm)\n"))

    def test_units_given_by_the_table_are_converted(self):
        self.put(log_text("t,p,x", lambda i: f"{0.1 * i / 60:.9f},{kpa(i) / 6.894757:.8f},{mm(i) / 1000:.9f}"))
        self.assert_log(self.read("""\
            time: {column: t, unit: min}
            command: {column: p, unit: psi}
            displacement: {column: x, unit: m}
            """))

    def test_volts_are_converted_by_scale_and_zero_or_by_span(self):
        self.put(log_text("t_s,dac,enc_V", lambda i: f"{0.1 * i:.1f},{kpa(i) / 20 + 1:.6f},{5 - mm(i):.6f}"))
        log = self.read("time: t_s\ncommand: {column: dac, scale: 20, zero: 1}\n"
                        "displacement: {column: enc_V, zero: 5, scale: -1}\n")
        self.assert_log(log)
        log = self.read("time: t_s\ncommand: {column: dac, scale: 20}\n"
                        "displacement: {column: enc_V, zero: first, span_mm: -30}\n")
        readings = log.columns["displacement"]
        self.assertAlmostEqual(max(readings) - min(readings), 30)
        self.assertEqual(readings[0], 0)
        self.assertGreater(readings[10], 0)

    def test_several_columns_are_averaged(self):
        self.put(log_text("t_s,a_kpa,b_kpa,y_mm", lambda i: f"{0.1 * i:.1f},{kpa(i) - 1},{kpa(i) + 1},{mm(i)}"))
        self.assert_log(self.read("time: t_s\ncommand: {columns: [a_kpa, b_kpa]}\ndisplacement: y_mm\n"))

    def test_separators_are_detected_or_taken_from_the_table(self):
        for separator, word in ((";", "semicolon"), ("\t", "tab"), ("|", "'|'"), (" ", "space")):
            for said in ("", f"separator: {word}\n"):
                with self.subTest(separator=separator, said=said):
                    self.put(log_text(separator.join(["t_s", "u_kpa", "y_mm"]),
                                      lambda i, by=separator: by.join([f"{0.1 * i:.1f}", f"{kpa(i)}", f"{mm(i)}"])))
                    self.assert_log(self.read(PLAIN + said))

    def test_decimal_commas_are_accepted(self):
        self.put(log_text("t_s;u_kpa;y_mm", lambda i: f"{0.1 * i:.1f};{kpa(i):.4f};{mm(i):.4f}".replace(".", ",")))
        self.assert_log(self.read(PLAIN))

    def test_text_above_the_header_and_a_unit_row_are_skipped(self):
        self.put("Rig 7, second day\n# comment\n\nt,u,y,remark\n(s),(kPa),(mm),\n"
                 + log_text("% more", lambda i: f"{0.1 * i:.1f},{kpa(i):.4f},{mm(i):.4f},\"a, b\""))
        self.assert_log(self.read("time: {column: t, unit: s}\ncommand: {column: u, unit: kPa}\n"
                                  "displacement: {column: y, unit: mm}\n"))

    def test_a_log_without_header_and_time_uses_column_numbers_and_a_rate(self):
        self.put(log_text("recorded by hand", lambda i: f"{i};{kpa(i):.4f};{mm(i):.4f}"))
        self.assert_log(self.read("time: {rate_hz: 10}\ncommand: {column: 2, unit: kpa}\n"
                                  "displacement: {column: 3, unit: mm}\n"))

    def test_dates_and_times_are_converted_to_seconds(self):
        self.put(log_text("when,u_kpa,y_mm", lambda i: f"2024-05-31 23:59:{55 + 0.1 * i:06.3f},{kpa(i):.4f},{mm(i):.4f}"
                          if i < 50 else f"2024-06-01T00:00:{0.1 * i - 5:06.3f},{kpa(i):.4f},{mm(i):.4f}"))
        self.assert_log(self.read("time: {column: when, unit: datetime}\ncommand: u_kpa\ndisplacement: y_mm\n"))

    def test_utf_8_latin_1_and_utf_16_encodings_are_read(self):
        text = log_text("t_s,u_kpa,y_µm", lambda i: f"{0.1 * i:.1f},{kpa(i):.4f},{1000 * mm(i):.4f}")
        for encoding in ("utf-8-sig", "latin-1", "utf-16"):
            with self.subTest(encoding=encoding):
                self.put(text.encode(encoding))
                self.assert_log(self.read("time: t_s\ncommand: u_kpa\ndisplacement: y_µm\n"))

    def test_kelvin_and_fahrenheit_are_converted_to_celsius(self):
        self.put(log_text("t_s,u_kpa,y_mm,T_K,T_F", lambda i: f"{0.1 * i:.1f},{kpa(i)},{mm(i)},293.15,68"))
        for column in ("T_K", "T_F"):
            self.assertAlmostEqual(self.read(PLAIN + f"temperature: {column}\n").columns["temperature"][0], 20, 6)

    def test_the_measured_pressure_replaces_a_missing_command(self):
        self.put_plain()
        log = self.read("time: t_s\npressure: u_kpa\ndisplacement: y_mm\n")
        self.assert_log(log)
        self.assertIn("no command was recorded", log.notes[0])

    def test_the_written_text_has_the_format_of_a_softgrip_log(self):
        self.put_plain(line3="0.1,NaN,NA")
        lines = self.read(PLAIN).text().splitlines()
        self.assertEqual(lines[0], "time_s,pressure_command_kpa,displacement_mm")
        self.assertEqual(lines[2], "0.1,0,")
        self.assertEqual(len(lines), SAMPLES + 1)


class Gaps(ForeignCase):
    def test_missing_readings_are_nan_and_missing_commands_are_held(self):
        self.put_plain(line7="0.5,,", line8="0.6,-999,-999.0", line9=f"0.7,{kpa(7)},#N/A")
        log = self.read(PLAIN + "missing: [-999]\n")
        self.assertEqual([i for i, y in enumerate(log.columns["displacement"]) if math.isnan(y)], [5, 6, 7])
        self.assertEqual(log.columns["command"][4:7], [log.columns["command"][4]] * 3)
        self.assertEqual(log.notes, ["2 samples without a command keep the one before"])

    def test_rows_without_a_time_or_with_a_repeated_time_are_skipped(self):
        self.put_plain(line7=",1,2", line11="0.8,1,2")
        log = self.read(PLAIN)
        self.assertEqual(len(log.time_s), SAMPLES - 2)
        self.assertEqual(len(log.notes), 2)

    def test_samples_without_a_reading_of_a_slow_sensor_are_skipped(self):
        self.put(log_text("t_s,u_kpa,y_mm", lambda i: f"{0.1 * i:.1f},{kpa(i)},{mm(i) if i % 4 == 0 else ''}"))
        log = self.read(PLAIN)
        self.assertEqual(len(log.time_s), 25)
        self.assertIn("75 of 100 samples without a displacement", log.notes[0])

    def test_the_longest_segment_between_gaps_is_kept(self):
        self.put(log_text("t_s,u_kpa,y_mm", lambda i: f"{0.1 * i + (7 if i > 37 else 0):.1f},{kpa(i)},{mm(i)}"))
        log = self.read(PLAIN)
        self.assertEqual(len(log.time_s), SAMPLES - 38)
        self.assertEqual((log.time_s[0], log.lines[0]), (0, 40))
        self.assertIn("the first before line 40", log.notes[0])

    def test_a_gap_with_a_constant_command_does_not_split_the_log(self):
        self.put(log_text("t_s,u_kpa,y_mm", lambda i: f"{0.1 * i + (7 if i > 30 else 0):.1f},{min(i, 20)},{mm(i)}"))
        self.assertEqual(len(self.read(PLAIN).time_s), SAMPLES)

    def test_from_s_and_to_s_select_a_time_range(self):
        self.put_plain()
        log = self.read(PLAIN + "from_s: 2\nto_s: 5\n")
        self.assertEqual((len(log.time_s), log.time_s[0], log.lines[0]), (31, 0, 22))

    def test_an_incomplete_last_line_is_skipped(self):
        self.put_plain(line101="9.9,1")
        log = self.read(PLAIN)
        self.assert_log(log, SAMPLES - 1)
        self.assertIn("cut off", log.notes[0])


class Broken(ForeignCase):
    def assert_says(self, keys, *words):
        said = self.spoiled(keys)
        for word in words:
            self.assertIn(word, said)

    def test_a_missing_file_is_reported(self):
        self.assert_says(PLAIN, "a.csv: No such file")

    def test_a_binary_spreadsheet_is_rejected_with_a_hint_to_use_csv(self):
        self.put(b"PK\x03\x04\0\0\0")
        self.assert_says(PLAIN, "a.csv: this is no text", "CSV")

    def test_an_empty_file_is_reported(self):
        self.put("\n# nothing\n")
        self.assert_says(PLAIN, "a.csv:1: the file is empty")

    def test_an_unknown_column_is_reported_with_a_similar_name(self):
        self.put_plain()
        self.assert_says(PLAIN.replace("u_kpa", "u_kps"), "a.csv:1: no column 'u_kps'", "is it 'u_kpa'?")

    def test_a_column_name_without_a_header_is_reported(self):
        self.put(log_text("0,0,0", lambda i: f"{0.1 * i + 1},{kpa(i)},{mm(i)}"))
        self.assert_says(PLAIN, "a.csv:1: no line names a column 't_s'", "by its number")

    def test_a_column_number_beyond_the_last_column_is_reported(self):
        self.put_plain()
        self.assert_says(PLAIN.replace("u_kpa", "{column: 7, unit: kpa}"), "a.csv:1: column 7: there are 3")

    def test_a_duplicate_column_name_is_reported(self):
        self.put(log_text("t_s,u_kpa,u_kpa,y_mm", lambda i: f"{0.1 * i},{kpa(i)},{kpa(i)},{mm(i)}"))
        self.assert_says(PLAIN, "a.csv:1: 'u_kpa' stands twice")

    def test_text_in_a_numeric_column_is_reported_with_line_and_column(self):
        self.put_plain(line50="4.8,open,3", **{f"line{60 + i}": "5.8,1,wet" for i in range(6)})
        said = self.spoiled(PLAIN).splitlines()
        self.assertEqual(said[0], "a.csv:50: column 'u_kpa': 'open' is no number")
        self.assertEqual(said[1], "a.csv:60: column 'y_mm': 'wet' is no number")
        self.assertEqual(said[-1], "2 more of these")

    def test_a_row_with_too_few_cells_is_reported(self):
        self.put_plain(line50="4.8,12")
        self.assert_says(PLAIN, "a.csv:50: 2 cells, where column 3 is asked for")

    def test_a_decreasing_time_is_reported(self):
        self.put_plain(line50="0.3,1,2")
        self.assert_says(PLAIN, "a.csv:50: the time goes back from 4.7 to 0.3 s", "two runs in one file?")

    def test_a_column_without_a_unit_is_reported(self):
        self.put(log_text("t,u,y", lambda i: f"{0.1 * i},{kpa(i)},{mm(i)}"))
        self.assert_says("time: t\ncommand: u\ndisplacement: y\n", "a.csv:1: time: neither the column's name 't'", "ms")

    def test_a_unit_of_another_quantity_is_reported(self):
        self.put(log_text("t_s,u_V,y_mm", lambda i: f"{0.1 * i},{kpa(i)},{mm(i)}"))
        self.assert_says("time: t_s\ncommand: u_V\ndisplacement: y_mm\n", "a.csv:1: command: neither", "psi", "`scale`")

    def test_a_column_without_readings_is_reported(self):
        self.put(log_text("t_s,u_kpa,y_mm", lambda i: f"{0.1 * i},{kpa(i)},NaN"))
        self.assert_says(PLAIN, "a.csv:1: displacement: no reading at all in 'y_mm'")

    def test_a_time_range_outside_the_log_is_reported(self):
        self.put_plain()
        self.assert_says(PLAIN + "from_s: 60\n", "a.csv:2: 0 samples between 60", "the log has 9.9 s")

    def test_a_log_without_data_rows_is_reported(self):
        self.put("t_s,u_kpa,y_mm\n")
        self.assert_says(PLAIN, "a.csv:1: no row of numbers")

    def test_an_invalid_date_is_reported(self):
        self.put(log_text("when,u_kpa,y_mm", lambda i: f"{31 if i else 32}.05.2024,{kpa(i)},{mm(i)}"))
        self.assert_says("time: {column: when, unit: datetime}\ncommand: u_kpa\ndisplacement: y_mm\n",
                         "a.csv:2: '32.05.2024' is no date")
