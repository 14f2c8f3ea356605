// driver_window: DATA is driven only between the second and the ninth falling edge of CLOCK in a frame; further only for a parameter.
// command_as_asked: DATA is LOW in the cell before the mode command, and then its six bits, the most significant first.
reg [5:0] f_falls; initial f_falls = 6'd0;
always @(posedge clock) begin
    if (reset | start_supplement) f_falls <= 6'd0;
    else if (fall & (f_falls != 6'd63)) f_falls <= f_falls + 6'd1;
    if (start & !reset) f_falls <= 6'd1;
end
always @* begin
    driver_window: assert (!oe | ((f_falls >= 6'd2) & (f_falls <= 6'd8)) | (HAS_ALL & (in_supplement | (|bits_left))));
    command_as_asked: assert (!oe | (cells_left == 4'd0) | (HAS_ALL & (in_supplement | (|bits_left))) | (data == ((f_falls == 6'd2) ? 1'b0 : command[6'd8 - f_falls])));
    driver_window_cells: assert ((cells_left == 4'd0) | ((f_falls <= 6'd8) & ({2'd0, cells_left} == 6'd9 - f_falls)));
end
