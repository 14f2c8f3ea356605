// driver_window: In a frame DATA is driven only from the tenth falling edge of CLOCK on; after a mode command with a parameter only from the thirty-fourth one. An early start bit on command may come with the rising edge before.
// driver_off: DATA is not driven after a reset, without plug and out of step with the receiver.
// answer_driven unless HAS_ERRORS (errors on command): DATA is driven from the start bit to the end of the recovery time.
// low_at_rest: DATA that is driven outside an answer and its recovery time is LOW.
reg f_past_valid; initial f_past_valid = 1'b0;
reg f_parameter; initial f_parameter = 1'b0;
reg [5:0] f_falls; initial f_falls = 6'd0;
reg [5:0] f_rises; initial f_rises = 6'd0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (pins_fall & (f_falls != 6'd63)) f_falls <= f_falls + 6'd1;
    if (pins_rise & (f_rises != 6'd62)) f_rises <= f_rises + 6'd1;
    if (decodes) f_parameter <= is_parameter;
    if (begins) begin
        f_falls <= 6'd1;
        f_rises <= 6'd0;
        f_parameter <= 1'b0;
    end
end
wire f_lead = (phase == PHASE_WAIT) | (phase == PHASE_REFUSE);
wire f_answer = (phase == PHASE_F1) | (phase == PHASE_F2) | (phase == PHASE_POSITION) | (phase == PHASE_CRC) | (phase == PHASE_TAIL) | (phase == PHASE_RECOVERY);
wire [5:0] f_last = f_parameter ? 6'd34 : 6'd10;
`ifndef FORMAL_ANY_STATE
always @* begin
    driver_window: assert (!oe_pin | (phase == PHASE_IDLE) | (f_falls >= f_last) | (HAS_ERRORS & (f_falls >= f_last - 6'd1)));
    driver_window_lemma_edges: assert (!((phase == PHASE_LISTEN) | (f_lead & (|left))) | (f_falls == f_rises + {5'd0, !pins_level_before}));
    driver_window_lemma_listen: assert ((phase != PHASE_LISTEN) | ((|left) & (left <= 6'd8) & (left + f_rises == 6'd8) & !f_parameter & !oe_pin));
    driver_window_lemma_lead: assert (!f_lead | !(|left) | ((left <= f_last - 6'd8) & (left + f_rises == f_last)));
    driver_window_lemma_answer: assert (!f_answer | (f_falls >= f_last - 6'd1));
    driver_window_lemma_wait: assert ((phase != PHASE_WAIT) | !f_parameter);
    answer_driven: assert (!f_answer | oe_pin | HAS_ERRORS);
    answer_driven_lemma_lead: assert (!f_lead | (oe_pin == ((left == 6'd0) | ((left == 6'd1) & !pins_level_before))));
    answer_driven_lemma_rest: assert ((phase != PHASE_IDLE) | oe_pin);
    low_at_rest: assert (!oe_pin | f_answer | !data_pin);
    low_at_rest_lemma_driver: assert (!((phase == PHASE_LISTEN) | f_lead) | !data_pin);
    driver_off: assert ((phase != PHASE_DEAF) | !oe_pin);
end
always @(posedge clock) if (f_past_valid & $past(reset | !plugged)) driver_off_then: assert (!oe_pin);
`endif
`ifdef FORMAL_ANY_STATE
// back_in_step: From any register contents an encoder with plug whose CLOCK has been HIGH for long is ready for a frame; only the recovery time goes on.
// recovery_ends: From any register contents the recovery time counts down to its end.
// clock_timed: The time since the last edge of CLOCK counts microseconds.
always @(posedge clock) if (f_past_valid & !$past(reset) & $past(plugged)) begin
    if ($past(is_high_long & (phase != PHASE_RECOVERY))) back_in_step: assert (phase == PHASE_IDLE);
    if ($past((phase == PHASE_RECOVERY) & is_due & !is_low_long)) recovery_ends: assert (phase != PHASE_RECOVERY);
    if ($past((phase == PHASE_RECOVERY) & !is_due)) recovery_ends_counts: assert (timer == $past(timer) - 16'd1);
    if ($past(!pins_rise & !pins_fall)) clock_timed: assert (level_us == $past(level_us) + {15'd0, $past(tick_us)});
end
`endif
