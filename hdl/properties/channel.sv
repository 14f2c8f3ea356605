// safe_after_reset: In the cycle after a reset CLOCK is HIGH and DATA is not driven.
// driver_as_sent: DATA is driven only if the command sender or the line probe asked for it in the cycle before.
// frame_is_driven: A frame is on the wire only while the channel is busy, and its settings do not change.
// positions_only: A frame of a trigger has a command whose answer is a position, with a request or without.
wire f_rides = command_now[5:3] == command_now[2:0] & command_now != 6'b000000 & command_now != 6'b010010 & command_now != 6'b111111;
wire f_bare = command_now == 6'b000111 | command_now == 6'b111000;
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid) begin
        if ($past(reset)) safe_after_reset: assert (endat_clk & !data_oe);
        else driver_as_sent: assert (!data_oe | $past(sender_oe | transaction_probe));
    end
end
always @* frame_is_driven: assert (!transaction_run | (!transaction_is_at_rest & busy));
always @* positions_only: assert (!transaction_start | frame_own | f_bare | f_rides);
// without HAS_GUARDS
// inputs: settings stay while the channel is busy and in the cycle of a trigger; every other input may be anything in every cycle
wire [68:0] f_settings = {period_cycles, first_low_extra_cycles, command, position_bits, filter_cycles, start_window_cycles, start_timeout_us, recovery_limit_cycles};
reg  [68:0] f_before;
reg f_stay; initial f_stay = 1'b0;
always @(posedge clock) begin
    f_before <= f_settings;
    f_stay <= busy | trigger;
end
always @* assume (!f_stay | (f_settings == f_before));
// end
