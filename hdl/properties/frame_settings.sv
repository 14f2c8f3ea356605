// settings_held: The settings that receive a frame change only while nothing is on the wire.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset) & !$past(is_at_rest)) begin
        settings_held: assert ($stable({period_cycles_now, first_low_extra_cycles_now, command_now, position_bits_now, filter_cycles_now,
            start_window_cycles_now, start_timeout_us_now, recovery_limit_cycles_now, recovery_min_cycles_now, watchdog_us_now, filter_half_now}));
    end
end
